// Playback control of a replay as a viewer of Foxglove's SDK protocol asks for it: pause, seek, speed, the end and back.
//   node replay_test.mjs PORT
import assert from "node:assert/strict";
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const url = `ws://127.0.0.1:${process.argv[2]}/`;
const DEADLINE_MS = 60_000; // generous: every wait ends with what it waits for
const STATUS = ["playing", "paused", "buffering", "ended"];

class Viewer {
  constructor() {
    this.states = [];
    this.frames = [];
    this.time = 0n;
    this.waiting = new Set();
    this.socket = new WebSocket(url, ["foxglove.sdk.v1"]);
    this.socket.binaryType = "arraybuffer";
    this.socket.on("message", (data, isBinary) => {
      if (isBinary) this.received(new DataView(data));
      else this.heard(JSON.parse(Buffer.from(data)));
      for (const look of [...this.waiting]) look();
    });
  }
  heard(message) {
    if (message.op === "serverInfo") this.info = message;
    if (message.op !== "advertise") return;
    for (const { id, topic } of message.channels)
      if (topic.endsWith("/depth/")) this.socket.send(JSON.stringify({ op: "subscribe", subscriptions: [{ id: 1, channelId: id }] }));
  }
  received(view) {
    if (view.getUint8(0) === 1) this.frames.push(view.getBigUint64(5, true));
    else if (view.getUint8(0) === 2) this.time = view.getBigUint64(1, true);
    else {
      assert.equal(view.getUint8(0), 5);
      const id = Buffer.from(view.buffer, 19, view.getUint32(15, true)).toString();
      this.states.push({ status: STATUS[view.getUint8(1)], time: view.getBigUint64(2, true), speed: view.getFloat32(10, true), didSeek: view.getUint8(14) === 1, id });
    }
  }
  /** Until `condition()` holds. */
  until(what, condition) {
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`did not come: ${what}; states ${JSON.stringify(this.states, (_, v) => (typeof v === "bigint" ? String(v) : v))}`)), DEADLINE_MS);
      const look = () => condition() && (this.waiting.delete(look), clearTimeout(timer), resolve());
      this.waiting.add(look);
      look();
    });
  }
  ask(id, { play, speed = 1, seek }) {
    const request = Buffer.alloc(19 + id.length);
    request.writeUInt8(3, 0);
    request.writeUInt8(play ? 0 : 1, 1);
    request.writeFloatLE(speed, 2);
    request.writeUInt8(seek === undefined ? 0 : 1, 6);
    request.writeBigUInt64LE(seek ?? 0n, 7);
    request.writeUInt32LE(id.length, 15);
    request.write(id, 19);
    this.socket.send(request);
    return this.until(`the answer to ${id}`, () => this.states.some((state) => state.id === id)).then(() => this.states.find((state) => state.id === id));
  }
}

const viewer = new Viewer();
await viewer.until("serverInfo", () => viewer.info);
const nanoseconds = ({ sec, nsec }) => BigInt(sec) * 1_000_000_000n + BigInt(nsec);
const begin = nanoseconds(viewer.info.dataStartTime), end = nanoseconds(viewer.info.dataEndTime);
assert.deepEqual(viewer.info.capabilities, ["time", "playbackControl", "services"]);
assert.ok(end - begin > 1_000_000_000n && end - begin < 60_000_000_000n, `${end - begin} ns recorded`);

// Paused at once, wherever it is; a seek shows its frame; times are those of recording.
const paused = await viewer.ask("pause", { play: false });
assert.equal(paused.status, "paused");
const middle = (begin + end) / 2n;
await viewer.until("a first frame", () => viewer.frames.length > 0);
viewer.frames.length = 0;
const sought = await viewer.ask("seek", { play: false, seek: middle });
assert.ok(sought.didSeek && sought.time === middle && sought.status === "paused", JSON.stringify(sought.status));
await viewer.until("the frame that was sought", () => viewer.frames.some((time) => time >= middle && time < middle + 500_000_000n));
await viewer.until("its time", () => viewer.time >= middle && viewer.time < middle + 500_000_000n);

// An older client that never asks is not told in a message that it does not know.
const older = new protocol.FoxgloveClient({ ws: new WebSocket(url, ["foxglove.websocket.v1"]) });
const troubles = [];
older.on("error", (error) => troubles.push(String(error)));
let itsTime = 0n;
older.on("time", ({ timestamp }) => (itsTime = timestamp));
await new Promise((resolve) => older.on("serverInfo", resolve));

// On to the end, five times as fast; there it waits, and can be wound back.
const playing = await viewer.ask("play", { play: true, speed: 5 });
assert.ok(playing.status === "playing" && playing.speed === 5);
await viewer.until("the end", () => viewer.states.at(-1).status === "ended" && viewer.states.at(-1).id === "");
assert.ok(end - viewer.time < 1_000_000n, "the last frame is the last");
viewer.frames.length = 0;
await viewer.ask("again", { play: true, seek: begin });
await viewer.until("the beginning again", () => viewer.frames.some((time) => time - begin < 500_000_000n));
assert.deepEqual(troubles, []);
assert.ok(itsTime >= begin && itsTime <= end, `${itsTime}`);

for (const nonsense of [Buffer.alloc(0), Buffer.from([3]), Buffer.from([9, 9]), Buffer.alloc(19, 3), Buffer.alloc(60_000, 0xff)]) viewer.socket.send(nonsense);
const after = await viewer.ask("still here", { play: false });
assert.equal(after.status, "paused");
console.log("ok");
process.exit(0);
