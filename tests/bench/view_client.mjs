// A viewer that takes what the page takes, and counts: node view_client.mjs PORT SECONDS
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const [port, seconds] = process.argv.slice(2).map(Number);
const client = new protocol.FoxgloveClient({ ws: new WebSocket(`ws://127.0.0.1:${port}/`, ["foxglove.sdk.v1"]) });
const WANTED = /^\/gfp\/(scene|mesh|status)\/$|\/(depth|color|camera)\/$/;
const topics = new Map(), counts = {};
let bytes = 0;
client.on("advertise", (channels) => channels.filter(({ topic }) => WANTED.test(topic)).forEach(({ id, topic }) => topics.set(client.subscribe(id), topic)));
client.on("message", ({ subscriptionId, data }) => {
  const name = topics.get(subscriptionId).split("/").at(-2);
  counts[name] = (counts[name] ?? 0) + 1;
  bytes += data.byteLength;
});
setTimeout(() => {
  console.log(JSON.stringify({ ...Object.fromEntries(Object.entries(counts).map(([name, count]) => [name, Math.round(count / seconds)])), MB: Math.round(bytes / seconds / 1e6) }));
  process.exit(0);
}, 1000 * seconds);
