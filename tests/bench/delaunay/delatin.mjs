// What bench_simplify measures, by delatin, a port of hmm: the same fractal terrain of 1025 x 1025 cells to 1, 5 and 20 %
// of its vertices. Prints processor seconds a million cells and microseconds a vertex; the first run, which warms
// up the compiler, is not shown. Usage: node delatin.mjs, in a folder where delatin is installed (npm install delatin).
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const found = createRequire(path.join(process.cwd(), "x.js")).resolve("delatin");
const { default: Delatin } = await import(pathToFileURL(found));

const side = 1025;

// The 64-bit Mersenne twister of Nishimura and Matsumoto, as std::mt19937_64 seeded with 1.
function* mersenne() {
  const all = (1n << 64n) - 1n;
  const state = [1n];
  for (let i = 1n; i < 312n; i++) {
    const last = state[Number(i) - 1];
    state.push((6364136223846793005n * (last ^ (last >> 62n)) + i) & all);
  }
  for (;;) {
    for (let i = 0; i < 312; i++) {
      const mixed = (state[i] & 0xffffffff80000000n) | (state[(i + 1) % 312] & 0x7fffffffn);
      state[i] = state[(i + 156) % 312] ^ (mixed >> 1n) ^ (mixed & 1n ? 0xb5026f5aa96619e9n : 0n);
    }
    for (let x of state) {
      x ^= (x >> 29n) & 0x5555555555555555n;
      x ^= (x << 17n) & 0x71d67fffeda60000n;
      x ^= (x << 37n) & 0xfff7eee000000000n;
      yield (x ^ (x >> 43n)) & all;
    }
  }
}

// Diamond-square: each halving of the step halves the roughness.
function fractalHeights() {
  const engine = mersenne();
  const noise = (size) => size * (Number(engine.next().value >> 11n) * 2 ** -52 - 1);
  const z = new Float64Array(side * side);
  let size = 400;
  for (let step = side - 1; step > 1; step /= 2, size /= 2) {
    const half = step / 2;
    for (let y = half; y < side; y += step) {
      for (let x = half; x < side; x += step) {
        const at = (dx, dy) => z[(y + dy) * side + x + dx];
        z[y * side + x] = (at(-half, -half) + at(half, -half) + at(-half, half) + at(half, half)) / 4 + noise(size);
      }
    }
    for (let y = 0; y < side; y += half) {
      for (let x = (y / half) % 2 === 0 ? half : 0; x < side; x += step) {
        let sum = 0, count = 0;
        for (const [px, py] of [[x - half, y], [x + half, y], [x, y - half], [x, y + half]]) {
          if (px < 0 || py < 0 || px >= side || py >= side) continue;
          sum += z[py * side + px];
          count++;
        }
        z[y * side + x] = sum / count + noise(size);
      }
    }
  }
  return z;
}

const heights = fractalHeights();
for (const percent of [1, 1, 5, 20]) {
  const wanted = Math.floor((side * side * percent) / 100);
  const begin = process.cpuUsage();
  const tin = new Delatin(heights, side);
  while (tin.coords.length / 2 < wanted) tin.refine();
  const { user, system } = process.cpuUsage(begin);
  const seconds = (user + system) / 1e6;
  if (percent === 1 && !globalThis.warm) {
    globalThis.warm = true;
    continue;
  }
  const error = tin.getMaxError().toFixed(3);
  console.log(`${percent} %: ${((seconds / (side * side)) * 1e6).toFixed(2)} s/Mcell, ` +
              `${((seconds / wanted) * 1e6).toFixed(1)} us/vertex, error ${error}`);
}
