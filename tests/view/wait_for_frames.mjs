// Returns when so many frames have come through the view: node wait_for_frames.mjs PORT COUNT
import protocol from "@foxglove/ws-protocol";
import { WebSocket } from "ws";

const [port, count] = process.argv.slice(2).map(Number);
const client = new protocol.FoxgloveClient({ ws: new WebSocket(`ws://127.0.0.1:${port}/`, ["foxglove.sdk.v1"]) });
let frames = 0;
client.on("advertise", (channels) => channels.filter(({ topic }) => topic.endsWith("/depth/")).forEach(({ id }) => client.subscribe(id)));
client.on("message", () => ++frames >= count && process.exit(0));
setTimeout(() => (console.error(`${frames} of ${count} frames came`), process.exit(1)), 120_000);
