// A client of the Foxglove WebSocket protocol: keeps the newest message of each channel and key, and reconnects by itself.
import { create, createFileRegistry, fromBinary, toBinary } from "@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";

const PLAYBACK = ["playing", "paused", "buffering", "ended"];
const SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];

function bytesOfBase64(text) {
  return Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
}

export class Connection {
  /**
   * `wanted(topic)` says whether to subscribe; `onMessage(topic, read, logTime_ms)`, `onState(state)`, `onTopics(topics)` and `onPlayback(playback)`
   * are told what happens. A playback is {begin_ns, end_ns, now_ns, status, speed} of the replay, or null where there is none.
   */
  constructor(url, { wanted, onMessage, onState, onTopics, onPlayback }) {
    Object.assign(this, { url, wanted, onMessage, onState, onTopics, onPlayback });
    this.retry_ms = 250;
    this.open();
  }

  open() {
    this.channels = new Map(); // id -> {topic, schema, subscription}
    this.bySubscription = new Map();
    this.nextSubscription = this.nextRequest = 1;
    this.playback = null;
    this.services = new Map(); // name -> {id, request, response}
    this.calls = new Map(); // id -> {response, resolve, reject}
    this.onState("connecting");
    const socket = new WebSocket(this.url, SUBPROTOCOLS);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => (typeof data === "string" ? this.heard(JSON.parse(data)) : this.received(data));
    socket.onclose = () => {
      for (const { reject } of this.calls.values()) reject(new Error("the connection was lost"));
      this.onState("lost");
      setTimeout(() => this.open(), this.retry_ms);
      this.retry_ms = Math.min(4000, 2 * this.retry_ms);
    };
    this.socket = socket;
  }

  send(message) {
    this.socket.send(JSON.stringify(message));
  }

  heard(message) {
    if (message.op === "serverInfo") {
      this.retry_ms = 250;
      const isNew = this.session !== undefined && this.session !== message.sessionId;
      this.session = message.sessionId;
      this.onState(isNew ? "restarted" : "live");
      this.beginPlayback(message);
    } else if (message.op === "advertise") {
      for (const channel of message.channels) {
        const registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, bytesOfBase64(channel.schema)));
        this.channels.set(channel.id, { topic: channel.topic, schema: registry.getMessage(channel.schemaName) });
      }
      this.onTopics([...this.channels.values()].map(({ topic }) => topic));
      this.review();
    } else if (message.op === "unadvertise") {
      for (const id of message.channelIds) this.channels.delete(id);
      this.onTopics([...this.channels.values()].map(({ topic }) => topic));
    } else if (message.op === "advertiseServices") {
      const schemaOf = ({ schema, schemaName }) => createFileRegistry(fromBinary(FileDescriptorSetSchema, bytesOfBase64(schema))).getMessage(schemaName);
      for (const { id, name, request, response } of message.services) this.services.set(name, { id, request: schemaOf(request), response: schemaOf(response) });
    } else if (message.op === "serviceCallFailure") {
      this.calls.get(message.callId)?.reject(new Error(message.message));
      this.calls.delete(message.callId);
    } else if (message.op === "status" && message.level > 0) {
      console.warn(message.message);
    }
  }

  /** Subscribes to what is wanted now, and to nothing else. */
  review() {
    const subscribe = [], unsubscribe = [];
    for (const [id, channel] of this.channels) {
      const wanted = this.wanted(channel.topic);
      if (wanted && channel.subscription === undefined) {
        channel.subscription = this.nextSubscription++;
        this.bySubscription.set(channel.subscription, channel);
        subscribe.push({ id: channel.subscription, channelId: id });
      } else if (!wanted && channel.subscription !== undefined) {
        unsubscribe.push(channel.subscription);
        this.bySubscription.delete(channel.subscription);
        channel.subscription = undefined;
      }
    }
    if (this.socket.readyState !== WebSocket.OPEN) return;
    if (subscribe.length) this.send({ op: "subscribe", subscriptions: subscribe });
    if (unsubscribe.length) this.send({ op: "unsubscribe", subscriptionIds: unsubscribe });
  }

  /** Playback states come only to who has asked for something: we ask for what is the case. */
  beginPlayback({ capabilities, dataStartTime, dataEndTime, metadata }) {
    this.playback = null;
    if (capabilities.includes("playbackControl")) {
      const nanoseconds = ({ sec, nsec }) => BigInt(sec) * 1_000_000_000n + BigInt(nsec);
      const begin_ns = nanoseconds(dataStartTime);
      this.playback = { begin_ns, end_ns: nanoseconds(dataEndTime), now_ns: begin_ns, status: metadata.playback, speed: Number(metadata.speed) || 1 };
      this.steer({});
    }
    this.onPlayback(this.playback);
  }

  /** Asks the replay to play or to pause, how fast, and where; what is not said stays. */
  steer({ play = this.playback.status === "playing", speed = this.playback.speed, seek_ns }) {
    const id = new TextEncoder().encode(String(this.nextRequest++));
    const request = new DataView(new ArrayBuffer(19 + id.length));
    request.setUint8(0, 3);
    request.setUint8(1, play ? 0 : 1);
    request.setFloat32(2, speed, true);
    request.setUint8(6, seek_ns === undefined ? 0 : 1);
    request.setBigUint64(7, seek_ns ?? 0n, true);
    request.setUint32(15, id.length, true);
    new Uint8Array(request.buffer).set(id, 19);
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(request.buffer);
  }

  /** Asks a service; resolves to its answer, or rejects with its reason. */
  call(name, fields) {
    const service = this.services.get(name);
    if (!service || this.socket.readyState !== WebSocket.OPEN) return Promise.reject(new Error("gfpd does not answer"));
    const payload = toBinary(service.request, create(service.request, fields)), encoding = new TextEncoder().encode("protobuf"), id = this.nextRequest++;
    const request = new DataView(new ArrayBuffer(13 + encoding.length + payload.length));
    request.setUint8(0, 2);
    request.setUint32(1, service.id, true);
    request.setUint32(5, id, true);
    request.setUint32(9, encoding.length, true);
    const bytes = new Uint8Array(request.buffer);
    bytes.set(encoding, 13);
    bytes.set(payload, 13 + encoding.length);
    this.socket.send(request.buffer);
    return new Promise((resolve, reject) => this.calls.set(id, { response: service.response, resolve, reject }));
  }

  answered(view) {
    const call = this.calls.get(view.getUint32(5, true));
    this.calls.delete(view.getUint32(5, true));
    call?.resolve(fromBinary(call.response, new Uint8Array(view.buffer, 13 + view.getUint32(9, true))));
  }

  received(buffer) {
    const view = new DataView(buffer);
    const opcode = view.getUint8(0);
    if (opcode === 3) return this.answered(view);
    if (opcode === 2 && this.playback) {
      this.playback.now_ns = view.getBigUint64(1, true);
      return this.onPlayback(this.playback);
    }
    if (opcode === 5 && this.playback) {
      Object.assign(this.playback, { status: PLAYBACK[view.getUint8(1)], now_ns: view.getBigUint64(2, true), speed: view.getFloat32(10, true) });
      return this.onPlayback(this.playback);
    }
    if (opcode !== 1) return;
    const channel = this.bySubscription.get(view.getUint32(1, true));
    if (!channel) return;
    const logTime_ms = Number(view.getBigUint64(5, true) / 1000n) / 1000;
    this.onMessage(channel.topic, () => fromBinary(channel.schema, new Uint8Array(buffer, 13)), logTime_ms);
  }
}
