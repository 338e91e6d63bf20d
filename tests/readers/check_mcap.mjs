// Reads logs with what Foxglove-compatible viewers read with: @mcap/core and protobufjs.
//
//   npm install && node check_mcap.mjs LOG...
//
// Every message is found by the index, decoded by the schema in the file, and in order of time.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { McapIndexedReader } from "@mcap/core";
import { loadDecompressHandlers, protobufFromBinaryDescriptor } from "@mcap/support";

const decompressHandlers = await loadDecompressHandlers();

for (const path of process.argv.slice(2)) {
  const bytes = readFileSync(path);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (from, length) => new Uint8Array(bytes.subarray(Number(from), Number(from + length))),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const { statistics, chunkIndexes } = reader;
  for (const chunk of chunkIndexes) {
    assert(chunk.messageIndexOffsets.size > 0, "a chunk without messages");
    assert(chunk.messageStartTime >= statistics.messageStartTime, "a chunk that begins before the log");
  }
  const types = new Map();
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    assert.equal(channel.messageEncoding, "protobuf");
    types.set(channel.id, protobufFromBinaryDescriptor(schema.data).lookupType(schema.name));
  }
  const counts = new Map();
  let last = 0n;
  let frames = 0;
  for await (const message of reader.readMessages()) {
    assert(message.logTime >= last && message.logTime === message.publishTime, "time runs back");
    last = message.logTime;
    const { topic } = reader.channelsById.get(message.channelId);
    const decoded = types.get(message.channelId).decode(message.data);
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
    if (topic === "/tf") {
      for (const { timestamp, rotation, translation, parentFrameId, parent_frame_id } of decoded.transforms) {
        const stamp = BigInt(timestamp.seconds) * 1_000_000_000n + BigInt(timestamp.nanos);
        assert.equal(stamp, message.logTime);
        const length = Math.hypot(rotation.x, rotation.y, rotation.z, rotation.w);
        assert(Math.abs(length - 1) < 1e-6, `a rotation of length ${length}`);
        assert(Number.isFinite(translation.x + translation.y + translation.z));
        assert((parentFrameId ?? parent_frame_id).length > 0);
        frames += 1;
      }
    } else if (topic === "/log") {
      assert(decoded.message.length > 0 && decoded.level >= 1 && decoded.level <= 3);
    } else if (topic === "/scene") {
      const text = decoded.entities.flatMap((entity) => entity.texts).map(({ text }) => text);
      assert.match(text[0], /bending × \d+, turning × \d+/);
      assert(decoded.entities.every((entity) => entity.frameLocked ?? entity.frame_locked));
    }
  }
  const total = [...counts.values()].reduce((sum, count) => sum + count, 0);
  assert.equal(BigInt(total), statistics.messageCount);
  console.log(`${path}: ${total} messages of ${counts.size} topics, ${frames} frames, ${chunkIndexes.length} chunks: good`);
}
