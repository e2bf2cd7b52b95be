// node check.mjs FILE: indexed and streamed reading agree, and every payload says what its schema promises.
import assert from "node:assert/strict";
import { readIndexed, readStreamed, typeOf } from "./read.mjs";

const file = process.argv[2];
const indexed = await readIndexed(file);
const streamed = await readStreamed(file);

const key = (m) => `${m.channelId} ${m.logTime} ${m.sequence} ${Buffer.from(m.data).toString("base64")}`;
assert.deepEqual(indexed.messages.map(key).sort(), streamed.map(key).sort(), "indexed and streamed reading differ");
for (let i = 1; i < indexed.messages.length; ++i) assert(indexed.messages[i - 1].logTime <= indexed.messages[i].logTime, "not in order of time");

const { statistics } = indexed;
assert.equal(Number(statistics.messageCount), indexed.messages.length);
assert.equal(statistics.chunkCount, indexed.chunks.length);
assert.equal(statistics.channelCount, indexed.channels.size);
assert.equal(statistics.schemaCount, indexed.schemas.size);
const counts = new Map();
for (const m of indexed.messages) counts.set(m.channelId, (counts.get(m.channelId) ?? 0n) + 1n);
assert.deepEqual([...counts].sort(), [...statistics.channelMessageCounts].sort());
for (const chunk of indexed.chunks) {
  assert.equal(chunk.compression, "zstd");
  assert(chunk.messageEndTime - chunk.messageStartTime <= 400_000_000n, "a chunk of more than 200 ms and one message");
}

const topics = new Map();
const checks = {
  "foxglove.RawImage": (m) => {
    assert(["16UC1", "rgb8"].includes(m.encoding));
    assert.equal(m.data.length, m.step * m.height);
    assert.equal(m.step, m.width * (m.encoding === "rgb8" ? 3 : 2));
    assert.match(m.frame_id, /_optical$/);
  },
  "foxglove.CameraCalibration": (m) => {
    assert.equal(m.K.length, 9);
    assert.equal(m.P.length, 12);
    assert(m.K[0] > 0 && m.K[8] === 1);
  },
  "foxglove.SceneUpdate": (m) => {
    for (const entity of m.entities) {
      const [mesh] = entity.triangles;
      assert.equal(mesh.colors.length, mesh.points.length);
      assert.equal(mesh.indices.length % 3, 0);
      assert(mesh.indices.length > 0 && Math.max(...mesh.indices) < mesh.points.length);
      const q = mesh.pose.orientation;
      assert(Math.abs(q.x ** 2 + q.y ** 2 + q.z ** 2 + q.w ** 2 - 1) < 1e-9);
    }
  },
  "foxglove.FrameTransforms": (m) => assert.equal((m.transforms[0].parent_frame_id), "world"),
  "gfp.v1.FrameInfo": (m) => assert(m.depth_scale_m > 0 && m.camera.camera.fx > 0),
  "gfp.v1.Topology": (m) => assert.equal(m.triangles.length % 12, 0),
  "gfp.v1.Scene": (m) => {
    for (const object of m.objects) assert.equal(object.vertices.positions.length, 6 * object.vertices.count, "int16 x y z");
  },
};
for (const message of indexed.messages) {
  const channel = indexed.channels.get(message.channelId);
  const schema = indexed.schemas.get(channel.schemaId);
  assert.equal(channel.messageEncoding, "protobuf");
  const check = checks[schema.name];
  assert(check, `schema ${schema.name} is not expected`);
  check(typeOf(schema).decode(message.data));
  topics.set(channel.topic, (topics.get(channel.topic) ?? 0) + 1);
}
for (const topic of ["/gfp/sensor/front/depth/", "/gfp/sensor/front/color/", "/gfp/sensor/front/camera/", "/gfp/sensor/front/frame/", "/gfp/scene/", "/gfp/mesh/", "/gfp/view/objects/", "/gfp/view/tf/"])
  assert(topics.has(topic), `no message on ${topic}`);
console.log(`${file}: ${indexed.messages.length} messages in ${indexed.chunks.length} chunks on ${topics.size} topics, indexed and streamed`);
