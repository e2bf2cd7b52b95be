"""A subscriber outside the container: ends when a scene with closed meshes and a grasp has come, or with an error after two minutes."""
import collections
import sys
import time

from gfp_client import SceneSubscriber


def is_closed(triangles):
    edges = collections.Counter()
    for a, b in ((0, 1), (1, 2), (2, 0)):
        edges.update(map(tuple, triangles[:, [a, b]]))
    return len(edges) > 0 and all(count == 1 and edges[(b, a)] == 1 for (a, b), count in edges.items())


scenes = SceneSubscriber()
deadline = time.monotonic() + 120
while time.monotonic() < deadline:
    scene = scenes.next(1)
    if scene is None or not scene.objects or any(thing.triangles is None for thing in scene.objects):
        continue
    if any(thing.grasps for thing in scene.objects):
        assert all(is_closed(thing.triangles) for thing in scene.objects), "a mesh is not closed"
        print(f"{len(scene.objects)} object(s) with closed meshes: {[thing.class_name for thing in scene.objects]}")
        sys.exit(0)
sys.exit("no scene with meshes and a grasp came within two minutes")
