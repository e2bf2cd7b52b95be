#!/usr/bin/env python3
"""Meshes and grasps of a running gfpd, in ten lines."""
from gfp_client import SceneSubscriber

for scene in SceneSubscriber():
    for thing in scene.objects:
        if thing.triangles is None or not thing.grasps:
            continue
        mesh = thing.vertices_camera()  # N x 3, metres; triangles are M x 3
        best = thing.grasps[0]
        print(thing.id, thing.class_name, mesh.mean(axis=0).round(3), thing.triangles.shape, f"{1e3 * best.width_m:.0f} mm", best.T_camera_tcp[:3, 3].round(3))
