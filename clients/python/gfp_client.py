"""Subscribes to a running gfpd and decodes what it publishes: scenes, meshes and grasps as numpy arrays.

Needs python3-zmq, python3-protobuf and python3-numpy, and no generated code: the messages are built from `gfp.desc`, the
FileDescriptorSet that the build makes. It is looked for in $GFP_DESCRIPTORS, beside this file, in the build folders of the
source tree, and in the installed share/gfp; where it is in none of them, the daemon on this host is asked for it.

    from gfp_client import SceneSubscriber
    for scene in SceneSubscriber():
        for thing in scene.objects:
            print(thing.id, thing.class_name, thing.vertices.shape, thing.triangles.shape, [g.width_m for g in thing.grasps])

Over tcp, with a key (`gfp key new me`, me.pub among the daemon's authorized keys):
    SceneSubscriber(["tcp://robot:5602"], curve=Curve("robot.pub", "me.key"))

Asking instead of listening: Control().snapshot(), .fit(), .best_grasp(), .parameters(), .set_parameters(), .recorder().

Metres and radians; camera frame x right, y down, z forward; T_a_b maps b coordinates into a (4x4).
"""

import contextlib
import ctypes
import dataclasses
import os
import pathlib
import time
import typing

import numpy as np
import zmq
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory


def default_endpoint(name: str) -> str:
    """Where gfpd and its clients meet without any configuration; `name` is sensor, state or control."""
    for variable in ("RUNTIME_DIRECTORY", "XDG_RUNTIME_DIR"):
        if os.environ.get(variable):
            return f"ipc://{os.environ[variable]}/gfp/{name}"
    return f"ipc:///tmp/gfp-{os.getuid()}/gfp/{name}"


def _descriptors() -> bytes:
    here = pathlib.Path(__file__).resolve().parent
    places = [pathlib.Path(os.environ["GFP_DESCRIPTORS"])] if "GFP_DESCRIPTORS" in os.environ else []
    places += [here / "gfp.desc"]
    places += [here.parents[1] / "build" / preset / "src/wire/generated/gfp.desc" for preset in ("release", "dev", "bench", "asan", "tsan")]
    places += [pathlib.Path(prefix) / "share/gfp/gfp.desc" for prefix in ("/usr/local", "/usr")]
    for place in places:
        if place.is_file():
            return place.read_bytes()
    socket = zmq.Context.instance().socket(zmq.REQ)
    socket.setsockopt(zmq.LINGER, 0)
    socket.connect(default_endpoint("control"))
    socket.send(b"desc")
    try:
        if socket.poll(3000):
            return socket.recv()
    finally:
        socket.close()
    raise FileNotFoundError("gfp.desc is in none of: " + ", ".join(map(str, places)) + ", and no gfpd runs here (name it in GFP_DESCRIPTORS)")


def _load_messages() -> dict:
    files = descriptor_pb2.FileDescriptorSet.FromString(_descriptors())
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.AddSerializedFile(file.SerializeToString())
    # Protobuf 4.22 and later have the second; before, the first.
    make = getattr(message_factory, "GetMessageClass", None) or message_factory.MessageFactory(pool).GetPrototype
    names = [f"{file.package}.{message.name}" for file in files.file for message in file.message_type]
    return {name: make(pool.FindMessageTypeByName(name)) for name in names}


MESSAGES = _load_messages()  # "gfp.v1.Scene" -> class


class Curve:
    """Keys for a daemon that serves tcp encrypted: its .pub file, and one's own .key file."""

    def __init__(self, server_file, own_file):
        self._server, self._own = self._read(server_file), self._read(own_file)

    @staticmethod
    def _read(file):
        lines = [line.split(": ", 1) for line in pathlib.Path(file).read_text().splitlines() if line.startswith(("public: ", "secret: "))]
        return {name: value.strip().encode() for name, value in lines}

    def apply(self, socket):
        socket.curve_serverkey = self._server["public"]
        socket.curve_publickey = self._own["public"]
        socket.curve_secretkey = self._own["secret"]


def _open_socket(kind, curve):
    socket = zmq.Context.instance().socket(kind)
    for option, value in ((zmq.LINGER, 0), (zmq.HEARTBEAT_IVL, 1000), (zmq.HEARTBEAT_TIMEOUT, 3000), (zmq.HEARTBEAT_TTL, 10_000), (zmq.RECONNECT_IVL_MAX, 1000), (zmq.IPV6, 1)):
        socket.setsockopt(option, value)
    if curve is not None:
        curve.apply(socket)
    return socket


class _Zstd:
    """Decompression by Debian's libzstd.so.1, which every Debian has."""

    MAX_BYTES = 256 << 20
    _library = None

    @classmethod
    def decompress(cls, compressed) -> memoryview:
        if cls._library is None:
            cls._library = ctypes.CDLL("libzstd.so.1")
            cls._library.ZSTD_getFrameContentSize.restype = ctypes.c_ulonglong
            cls._library.ZSTD_decompress.restype = ctypes.c_size_t
        source = bytes(compressed)
        size = cls._library.ZSTD_getFrameContentSize(source, ctypes.c_size_t(len(source)))
        if size > cls.MAX_BYTES:  # both of its error codes are larger
            raise ValueError("no zstd frame of a size that is read")
        content = ctypes.create_string_buffer(max(1, size))
        if cls._library.ZSTD_decompress(content, ctypes.c_size_t(size), source, ctypes.c_size_t(len(source))) != size:
            raise ValueError("damaged zstd")
        return memoryview(content).cast("B")[:size]


def _blob(envelope, part) -> memoryview:
    if envelope.encoding == 1:
        return _Zstd.decompress(part.buffer)
    if envelope.encoding != 0:
        raise ValueError(f"encoding {envelope.encoding}, expected raw or zstd")
    return part.buffer


@dataclasses.dataclass
class Message:
    topic: str
    envelope: typing.Any  # gfp.v1.Envelope
    payload: typing.Any  # The message that envelope.schema names.
    blob: memoryview  # Pixels of images; else empty.
    age_s: float  # From publishing to receiving, by this host's clock.


class Subscriber:
    """Messages of the given topics (or prefixes of topics). Reconnects by itself; counts what was missed."""

    def __init__(self, topics, endpoints=None, high_water_mark=1000, curve=None):
        self.received = self.missed = self.restarts = 0
        self.heard = time.monotonic()  # When the last message came: a daemon says something every second.
        self._last = {}  # topic -> (session, seq)
        self._socket = _open_socket(zmq.SUB, curve)
        self._socket.setsockopt(zmq.RCVHWM, high_water_mark)
        for topic in topics:
            self._socket.setsockopt_string(zmq.SUBSCRIBE, topic)
        names = {"sensor" if topic.startswith("/gfp/sensor/") else "state" for topic in topics}
        for endpoint in endpoints or [default_endpoint(name) for name in sorted(names)]:
            self._socket.connect(endpoint)

    def receive(self, timeout_s=None):
        """The next message, or None where none comes in time (None: wait for ever)."""
        if not self._socket.poll(None if timeout_s is None else max(0, round(1000 * timeout_s))):
            return None
        parts = self._socket.recv_multipart(copy=False)
        envelope = MESSAGES["gfp.v1.Envelope"].FromString(parts[1].buffer)
        payload = MESSAGES[envelope.schema].FromString(parts[2].buffer)
        topic = parts[0].bytes.decode()
        self._count(topic, envelope)
        blob = _blob(envelope, parts[3]) if len(parts) > 3 else memoryview(b"")
        return Message(topic, envelope, payload, blob, time.time() - 1e-9 * envelope.stamp_publish_ns)

    def _count(self, topic, envelope):
        self.received += 1
        self.heard = time.monotonic()
        session, seq = self._last.get(topic, (envelope.session, envelope.seq - 1))
        if session != envelope.session:
            self.restarts += 1
        elif envelope.seq > seq + 1:
            self.missed += envelope.seq - seq - 1
        self._last[topic] = (envelope.session, envelope.seq)

    def close(self):
        self._socket.close()


def transform(message) -> np.ndarray:
    """4x4 of a gfp.v1.Transform."""
    return np.array(message.matrix, dtype=np.float64).reshape(4, 4)


def depth_m(message: Message) -> np.ndarray:
    """Metres, height x width, 0 where there is no reading, of a message of /gfp/sensor/<name>/depth/."""
    image = message.payload
    return np.frombuffer(message.blob, "<u2").reshape(image.height, image.width) * np.float32(image.scale_m)


class Grasp:
    """One gfp.v1.Grasp; its transforms as 4x4, all else as in the message."""

    def __init__(self, message):
        self.message = message
        self.T_camera_tcp = transform(message.T_camera_tcp)
        self.T_camera_parent = transform(message.T_camera_parent)
        self.T_camera_pregrasp_tcp = transform(message.T_camera_pregrasp_tcp)

    def __getattr__(self, name):
        return getattr(self.message, name)


class SceneObject:
    """One gfp.v1.SceneObject. Arrays share the memory of the received message: they are read-only and not copied.

    vertices  N x 3, object frame, metres (float32; of int16 messages a float64 array is computed)
    triangles M x 3, counter-clockwise seen from outside; None until the topology has arrived (at most a second)
    observed  N, True where the vertex was seen, else inferred;  sigma_m  N, standard deviation along the normal
    """

    def __init__(self, message, topology):
        self.message = message
        self.T_camera_object = transform(message.T_camera_object)
        self.grasps = [Grasp(grasp) for grasp in message.grasps]
        sent = message.vertices
        if sent.encoding == 0:
            self.vertices = np.frombuffer(sent.positions, "<f4").reshape(-1, 3)
            self.sigma_m = np.frombuffer(sent.sigma, "<f4")
        else:
            self.vertices = np.array(sent.origin) + sent.scale * np.frombuffer(sent.positions, "<i2").reshape(-1, 3)
            self.sigma_m = sent.sigma_scale * np.frombuffer(sent.sigma, "<u2")
        self.observed = np.frombuffer(sent.states, np.uint8) & 1 == 1
        self.triangles = None if topology is None else np.frombuffer(topology.triangles, "<i4").reshape(-1, 3)

    def __getattr__(self, name):
        return getattr(self.message, name)

    def vertices_camera(self) -> np.ndarray:
        return self.vertices @ self.T_camera_object[:3, :3].T + self.T_camera_object[:3, 3]


class Scene:
    """One gfp.v1.Scene with its objects' meshes."""

    def __init__(self, message: Message, topologies):
        self.message = message.payload
        self.envelope = message.envelope
        self.age_s = message.age_s
        self.objects = [SceneObject(one, topologies.get(one.vertices.topology_hash)) for one in message.payload.objects]
        self.T_camera_support = transform(message.payload.support.T_camera_support) if message.payload.HasField("support") else None

    def __getattr__(self, name):
        return getattr(self.message, name)


class SceneSubscriber:
    """Scenes with their meshes put together. Iterate for ever, or call next(timeout_s)."""

    def __init__(self, endpoints=None, curve=None):
        self.subscriber = Subscriber(["/gfp/mesh/", "/gfp/scene/"], endpoints, curve=curve)
        self._topologies = {}

    def next(self, timeout_s=None):
        """The next scene, or None where none comes in time."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            message = self.subscriber.receive(None if deadline is None else deadline - time.monotonic())
            if message is None:
                return None
            if message.envelope.schema == "gfp.v1.Topology":
                self._topologies.setdefault(message.payload.hash, message.payload)
            else:
                return Scene(message, self._topologies)

    def __iter__(self):
        while True:
            yield self.next()


class Control:
    """Asks a gfpd; RuntimeError with its reason where it refuses, TimeoutError where it does not answer."""

    def __init__(self, endpoint=None, timeout_s=5.0, curve=None):
        self._timeout_s = timeout_s
        self._next_id = 1
        self._socket = _open_socket(zmq.DEALER, curve)
        self._socket.connect(endpoint or default_endpoint("control"))

    def ask(self, **request):
        """The gfp.v1.ControlReply to a gfp.v1.ControlRequest, as in ask(snapshot={"prefix": "/gfp/scene/"})."""
        message = MESSAGES["gfp.v1.ControlRequest"](id=self._next_id, **request)
        self._next_id += 1
        self._socket.send(message.SerializeToString())
        end = time.monotonic() + self._timeout_s
        while self._socket.poll(max(0, round(1000 * (end - time.monotonic())))):
            reply = MESSAGES["gfp.v1.ControlReply"].FromString(self._socket.recv())
            if reply.id != message.id:
                continue  # the answer to a question that was given up
            if reply.code != 0:
                raise RuntimeError(reply.error)
            return reply
        raise TimeoutError(f"no answer in {self._timeout_s} s")

    def snapshot(self, prefix=""):
        """[(topic, next_seq, payload)] of the state topics; messages of a topic from next_seq on are newer."""
        return [(entry.topic, entry.next_seq, MESSAGES[entry.schema].FromString(entry.payload)) for entry in self.ask(snapshot={"prefix": prefix}).snapshot.entries]

    def fit(self, sensor="", region_px=()):
        """The objects of a sensor's last frame, fitted anew; with a region (u0, v0, u1, v1) those inside it."""
        fit = self.ask(fit={"sensor": sensor, "region_px": region_px}).fit
        topologies = {topology.hash: topology for topology in fit.topologies}
        return [SceneObject(one, topologies.get(one.vertices.topology_hash)) for one in fit.scene.objects]

    def best_grasp(self, object_id, sensor=""):
        """(Grasp, T_base_tcp) of the best grasp that the robot reaches."""
        found = self.ask(grasp={"object": object_id, "sensor": sensor}).grasp
        return Grasp(found.grasp), transform(found.T_base_tcp)

    def parameters(self, *prefixes):
        return dict(self.ask(get_parameters={"prefixes": prefixes}).parameters.values)

    def set_parameters(self, **values):
        """As in set_parameters(**{"pipeline.segmentation.min_points": 200}); all or nothing, from the next frame on."""
        return dict(self.ask(set_parameters={"values": {path: str(value) for path, value in values.items()}}).parameters.values)

    def recorder(self, action="status"):
        """A gfp.v1.Recording after `start`, `stop`, `trigger` (of the ring) or `status` of the daemon's own recorder."""
        return self.ask(record={"action": f"ACTION_{action.upper()}"}).recording

    def close(self):
        self._socket.close()


def _print_scenes():
    for scene in SceneSubscriber():
        print(f"{scene.header.sensor} frame {scene.header.sequence}, {1e3 * scene.age_s:.1f} ms old")
        for thing in scene.objects:
            mesh = "mesh to come" if thing.triangles is None else f"{len(thing.vertices)} vertices, {len(thing.triangles)} triangles"
            best = f"grasp {1e3 * thing.grasps[0].width_m:.0f} mm wide" if thing.grasps else thing.no_grasp_reason
            print(f"  {thing.id:4} {thing.class_name:14} at {thing.T_camera_object[:3, 3].round(3)}  {mesh}, {best}")


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):  # how it is told to end
        _print_scenes()
