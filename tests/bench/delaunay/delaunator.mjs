// One measurement of tools/dev/bench: delaunator on a file of doubles x, y. Prints seconds and bytes as JSON.
// Usage: node delaunator.mjs FILE, in a folder where delaunator is installed.
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const found = createRequire(path.join(process.cwd(), "x.js")).resolve("delaunator");
const { default: Delaunator } = await import(pathToFileURL(found));
const file = fs.readFileSync(process.argv[2]);
const coordinates = new Float64Array(file.buffer, file.byteOffset, file.byteLength / 8);
const before = process.memoryUsage.rss();
const processor = process.cpuUsage();
const start = process.hrtime.bigint();
const { triangles } = new Delaunator(coordinates);
const wall = Number(process.hrtime.bigint() - start) / 1e9;
const { user, system } = process.cpuUsage(processor);
if (triangles.length === 0) process.exit(1);
const bytes = process.resourceUsage().maxRSS * 1024 - before;
console.log(JSON.stringify({ wall, processor: (user + system) / 1e6, bytes }));
