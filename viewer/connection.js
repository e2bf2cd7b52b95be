// A client of the Foxglove WebSocket protocol: keeps the newest message of each channel and key, and reconnects by itself.
import { createFileRegistry, fromBinary } from "@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";

const SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];

function bytesOfBase64(text) {
  return Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
}

export class Connection {
  /** `wanted(topic)` says whether to subscribe; `onMessage(topic, value, logTime)` and `onState(state)` are told what happens. */
  constructor(url, { wanted, onMessage, onState }) {
    Object.assign(this, { url, wanted, onMessage, onState });
    this.retry_ms = 250;
    this.open();
  }

  open() {
    this.channels = new Map(); // id -> {topic, schema, subscription}
    this.bySubscription = new Map();
    this.nextSubscription = 1;
    this.onState("connecting");
    const socket = new WebSocket(this.url, SUBPROTOCOLS);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => (typeof data === "string" ? this.heard(JSON.parse(data)) : this.received(data));
    socket.onclose = () => {
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
    } else if (message.op === "advertise") {
      for (const channel of message.channels) {
        const registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, bytesOfBase64(channel.schema)));
        this.channels.set(channel.id, { topic: channel.topic, schema: registry.getMessage(channel.schemaName) });
      }
      this.review();
    } else if (message.op === "unadvertise") {
      for (const id of message.channelIds) this.channels.delete(id);
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

  received(buffer) {
    const view = new DataView(buffer);
    if (view.getUint8(0) !== 1) return;
    const channel = this.bySubscription.get(view.getUint32(1, true));
    if (!channel) return;
    const logTime_ms = Number(view.getBigUint64(5, true) / 1000n) / 1000;
    this.onMessage(channel.topic, () => fromBinary(channel.schema, new Uint8Array(buffer, 13)), logTime_ms);
  }
}
