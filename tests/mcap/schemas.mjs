// node schemas.mjs FILE: every foxglove.* message in the file's schemas has the fields, numbers and types that @foxglove/schemas publishes.
import assert from "node:assert/strict";
import { foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto } from "@foxglove/schemas/internal.js";
import protobuf from "protobufjs";
import { readIndexed, typeOf } from "./read.mjs";

const theirs = new protobuf.Root();
for (const schema of Object.values(foxgloveMessageSchemas)) {
  const enums = Object.values(foxgloveEnumSchemas).filter((candidate) => candidate.parentSchemaName === schema.name);
  protobuf.parse(generateProto(schema, enums), theirs, { keepCase: true });
}
for (const name of ["Timestamp", "Duration"]) theirs.define("google.protobuf").add(new protobuf.Type(name));
theirs.resolveAll();

const canonical = (name) => name.replace(/_/g, "").toLowerCase();
const shape = (type) =>
  type.fieldsArray
    .map((f) => `${f.id} ${canonical(f.name)} ${f.repeated ? "repeated " : ""}${f.resolvedType ? f.resolvedType.fullName : f.type}`)
    .sort();

const { schemas } = await readIndexed(process.argv[2]);
const seen = new Set();
function compare(type) {
  if (seen.has(type.fullName) || !type.fullName.startsWith(".foxglove.")) return;
  seen.add(type.fullName);
  assert.deepEqual(shape(type), shape(theirs.lookupType(type.fullName)), type.fullName);
  for (const field of type.fieldsArray) {
    if (field.resolvedType instanceof protobuf.Type) compare(field.resolvedType);
    if (field.resolvedType instanceof protobuf.Enum) assert.deepEqual({ ...field.resolvedType.values }, { ...theirs.lookupEnum(field.resolvedType.fullName).values }, field.resolvedType.fullName);
  }
}
for (const schema of schemas.values()) if (schema.name.startsWith("foxglove.")) compare(typeOf(schema));
assert(seen.size >= 15, `${seen.size} messages compared`);
console.log(`${seen.size} foxglove messages are as @foxglove/schemas has them`);
