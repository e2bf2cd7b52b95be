// The view as an independent client sees it: @foxglove/ws-protocol over both subprotocols, payloads decoded with the schemas that the
// server sends and nothing else.   node conformance_test.mjs PORT
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import http from "node:http";
import { create, createFileRegistry, fromBinary, toBinary } from "@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const { FoxgloveClient } = protocol;
const port = Number(process.argv[2]);
const url = `ws://127.0.0.1:${port}/`;
const DEADLINE_MS = 60_000; // generous: every wait ends with what it waits for

function within(what, promise) {
  return Promise.race([promise, new Promise((_, reject) => setTimeout(() => reject(new Error(`did not come: ${what}`)), DEADLINE_MS).unref())]);
}

/** Subscribes to every channel; resolves when each topic in `wanted` has delivered, with the decoded messages by topic. */
async function listen(subprotocol, wanted) {
  const client = new FoxgloveClient({ ws: new WebSocket(url, [subprotocol]) });
  const schemas = new Map(), topics = new Map(), heard = new Map();
  let info;
  await within(`${wanted} over ${subprotocol}`, new Promise((resolve, reject) => {
    client.on("error", reject);
    client.on("close", () => reject(new Error("the server closed the connection")));
    client.on("serverInfo", (message) => (info = message));
    client.on("advertise", (channels) => {
      for (const channel of channels) {
        assert.equal(channel.encoding, "protobuf");
        const registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, Buffer.from(channel.schema, "base64")));
        schemas.set(channel.topic, registry.getMessage(channel.schemaName));
        assert.ok(schemas.get(channel.topic), `${channel.topic}: its schema does not define ${channel.schemaName}`);
        topics.set(client.subscribe(channel.id), channel.topic);
      }
    });
    client.on("message", ({ subscriptionId, timestamp, data }) => {
      const topic = topics.get(subscriptionId);
      assert.ok(timestamp > 1_500_000_000_000_000_000n, `${topic}: ${timestamp} is no time of this century`);
      heard.set(topic, fromBinary(schemas.get(topic), new Uint8Array(data.buffer, data.byteOffset, data.byteLength)));
      if (wanted.every((one) => heard.has(one)) && heard.get("/gfp/scene/").objects.length > 0) resolve();
    });
  }));
  client.close();
  assert.ok(info.name.startsWith("gfpd") && info.sessionId.length === 16, JSON.stringify(info));
  return heard;
}

function status(headers, path = "/") {
  return new Promise((resolve, reject) => {
    const request = http.get({ host: "127.0.0.1", port, path, headers }, (response) => resolve(response.resume().statusCode));
    request.on("upgrade", (_, socket) => (socket.destroy(), resolve(101)));
    request.on("error", reject);
  });
}
const handshake = (more) => ({ Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==", "Sec-WebSocket-Protocol": "foxglove.sdk.v1", ...more });

const streams = ["depth", "camera", "cloud", "transforms"].map((stream) => `/gfp/sensor/virtual/${stream}/`);
for (const subprotocol of ["foxglove.websocket.v1", "foxglove.sdk.v1"]) {
  const heard = await listen(subprotocol, ["/gfp/scene/", "/gfp/markers/", "/gfp/mesh/", "/gfp/status/", ...streams]);
  const scene = heard.get("/gfp/scene/"), depth = heard.get(streams[0]), cloud = heard.get(streams[2]);
  assert.equal(depth.data.length, 2 * depth.width * depth.height);
  assert.equal(cloud.data.length % cloud.pointStride, 0);
  const readings = new Uint16Array(depth.data.slice().buffer).filter((mm) => mm > 0).length;
  assert.ok(Math.abs(cloud.data.length / cloud.pointStride - readings) < 0.2 * readings, "about a point a reading"); // another frame's
  for (const object of scene.objects) assert.equal(object.vertices.positions.length, 6 * object.vertices.count, "int16 positions");
  const entity = heard.get("/gfp/markers/").entities[0];
  assert.ok(entity.triangles[0].indices.length >= 12 && entity.lifetime.seconds === 3n && entity.frameId === "virtual_optical");
}

// Control points by hand, as a call of a service: asked for, said, refused.
{
  const client = new FoxgloveClient({ ws: new WebSocket(url, ["foxglove.sdk.v1"]) });
  const [service] = await within("the services", new Promise((resolve) => client.on("advertiseServices", resolve)));
  assert.deepEqual([service.name, service.type], ["/gfp/primitive/retype", "gfp.v1.RetypeRequest"]);
  const messageOf = ({ schema, schemaName }) => createFileRegistry(fromBinary(FileDescriptorSetSchema, Buffer.from(schema, "base64"))).getMessage(schemaName);
  const [Request, Response] = [service.request, service.response].map(messageOf);
  let callId = 0;
  const call = (fields, serviceId = service.id) => {
    const id = ++callId;
    client.sendServiceCallRequest({ serviceId, callId: id, encoding: "protobuf", data: new DataView(toBinary(Request, create(Request, fields)).slice().buffer) });
    return within("an answer", new Promise((resolve) => {
      client.on("serviceCallResponse", (answer) => answer.callId === id && resolve(fromBinary(Response, new Uint8Array(answer.data.buffer, answer.data.byteOffset, answer.data.byteLength))));
      client.on("serviceCallFailure", (failed) => failed.callId === id && resolve(failed.message));
    }));
  };
  const before = await call({ primitive: "mug" });
  assert.equal(before.file, "");
  assert.ok(before.types.length > 100 && before.manualTypes.length === before.types.length && before.manualTypes.every((type) => type === 0));
  const flip = before.types.findIndex((type) => type === 0);
  const after = await call({ primitive: "mug", vertices: [flip], type: 2 });
  assert.deepEqual([after.changed, after.types[flip], after.manualTypes[flip]], [1, 1, 2]);
  const kept = JSON.parse(execFileSync(process.env.GFP_TOOL, ["primitive", "retype", "mug", "--primitives", process.env.GFP_PRIMITIVES, "--json"]));
  assert.deepEqual(kept.manual.map(({ vertex, type }) => [vertex, type]), [[flip, "control"]]);
  assert.deepEqual([...(await call({ primitive: "mug", vertices: [flip], type: 0 })).types], [...before.types]);
  assert.match(await call({ primitive: "zeppelin" }), /class = zeppelin/);
  assert.match(await call({ primitive: "mug", vertices: [before.types.length], type: 1 }), /expected below/);
  assert.match(await call({ primitive: "mug", vertices: [1], type: 7 }), /type = 7/);
  assert.equal(await call({}, 99), "no service 99");
  assert.deepEqual([...(await call({ primitive: "mug" })).manualTypes], [...before.manualTypes]);
  client.close();
}

// Several offered: the newer; none of ours: no connection.
assert.equal(await new Promise((resolve) => { const ws = new WebSocket(url, ["x", "foxglove.websocket.v1", "foxglove.sdk.v1"]); ws.on("open", () => (resolve(ws.protocol), ws.terminate())); }), "foxglove.sdk.v1");
assert.equal(await status(handshake({ "Sec-WebSocket-Protocol": "chat" })), 400);
// Pages of other hosts do not get in, nor does a name that was made to resolve to us; our own page and programs do.
assert.equal(await status(handshake({ Origin: "http://evil.example" })), 403);
assert.equal(await status(handshake({ Host: "evil.example:8765" })), 403);
assert.equal(await status(handshake({ Origin: `http://127.0.0.1:${port}` })), 101);
assert.equal(await status(handshake({})), 101);
assert.equal(await status({}), 200);
assert.equal(await status({}, "/etc/passwd"), 404);
assert.ok([400, 413, 431].includes(await status({ Cookie: "x".repeat(10_000) }).catch(() => 431)), "a header beyond the limit is refused");

// Nonsense gets an answer or an end; who sends more than a message may have is cut off. The next client is served.
for (const nonsense of ["{", "[]", '{"op":5}', '{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1e99}]}', '{"op":"subscribe","subscriptions":[{"id":1,"channelId":99999}]}', '{"op":"advertise","channels":[]}', "x".repeat(200_000)]) {
  const ws = new WebSocket(url, ["foxglove.sdk.v1"]);
  await within(`an answer to ${nonsense.slice(0, 40)}`, new Promise((resolve) => {
    ws.on("error", resolve);
    ws.on("close", resolve);
    ws.on("open", () => ws.send(nonsense));
    ws.on("message", (data, isBinary) => !isBinary && JSON.parse(data).op === "status" && resolve());
  }));
  ws.terminate();
}
await listen("foxglove.sdk.v1", ["/gfp/scene/"]);
console.log("ok");
process.exit(0);
