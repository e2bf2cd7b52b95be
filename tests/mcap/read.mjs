// Both ways that @mcap/core reads a file, and a decoder for its payloads out of the file's own schemas.
import { open, readFile } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { decompress } from "fzstd";
import protobuf from "protobufjs";
import "protobufjs/ext/descriptor/index.js";

const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };

export async function readIndexed(path) {
  const handle = await open(path, "r");
  const reader = await McapIndexedReader.Initialize({ readable: new FileHandleReadable(handle), decompressHandlers });
  const messages = [];
  for await (const message of reader.readMessages()) messages.push({ ...message, data: message.data.slice() });
  await handle.close();
  return { messages, channels: reader.channelsById, schemas: reader.schemasById, statistics: reader.statistics, chunks: reader.chunkIndexes };
}

export async function readStreamed(path) {
  const bytes = await readFile(path);
  const reader = new McapStreamReader({ decompressHandlers, includeChunks: false, validateCrcs: true });
  const messages = [];
  for (let at = 0; at < bytes.length; at += 100_000) {
    reader.append(bytes.subarray(at, at + 100_000));
    for (let record; (record = reader.nextRecord()); ) if (record.type === "Message") messages.push({ ...record, data: record.data.slice() });
  }
  if (!reader.done()) throw new Error("the stream does not end as a file should");
  return messages;
}

const roots = new Map();
export function typeOf(schema) {
  if (schema.encoding !== "protobuf") throw new Error(`schema ${schema.name} is ${schema.encoding}`);
  if (!roots.has(schema.id)) roots.set(schema.id, protobuf.Root.fromDescriptor(schema.data).resolveAll());
  return roots.get(schema.id).lookupType(schema.name);
}
