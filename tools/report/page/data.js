// What the page carries: JSON, and binary chunks that are unpacked when they are needed.

const report = JSON.parse(document.getElementById('report').textContent);

async function chunk(number) {
  const text = atob(document.getElementById('chunk-' + number).textContent);
  const packed = Uint8Array.from(text, letter => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

// The whole numbers of a column, all frames after each other: differences in time and along the particles undone.
async function unpackLevels(column, width) {
  const bytes = new Uint8Array(await chunk(column.chunk)), wide = column.bits === 16;
  const count = wide ? bytes.length / 2 : bytes.length, frames = width > 0 ? count / width : 0;
  const levels = wide ? new Uint16Array(count) : bytes;
  if (wide) for (let i = 0; i < count; ++i) levels[i] = bytes[i] | bytes[count + i] << 8;
  if (column.space_order > 0)
    for (let f = 0; f < frames; ++f)
      for (let i = f * width + 1; i < (f + 1) * width; ++i) levels[i] += levels[i - 1];
  if (column.time_order > 0)
    for (let f = 1; f < frames; ++f)
      for (let i = f * width; i < (f + 1) * width; ++i)
        levels[i] += column.time_order === 1 || f === 1 ? levels[i - width] : 2 * levels[i - width] - levels[i - 2 * width];
  return levels;
}

// A column of the frames: its levels and what they stand for.
class Column {
  constructor(described, levels) {
    Object.assign(this, described);
    this.levels = levels;
    this.none = this.bits === 16 ? 0xffff : 0xff;
    if (this.table) this.table = Float64Array.from(this.table);
  }
  static async read(described, width) { return new Column(described, await unpackLevels(described, width)); }
  value(level) {
    if (level === this.none) return NaN;
    return this.table ? this.table[level] : this.lower + this.spacing * level;
  }
  // How far a value may be from what the run wrote.
  rounding() {
    if (!this.table) return this.spacing / 2;
    let widest = 0;
    for (let k = 1; k < this.table.length; ++k) widest = Math.max(widest, this.table[k] - this.table[k - 1]);
    return widest / 2;
  }
  // From the least to the largest value of some levels, leaving out a share at both ends; null where there is no value.
  range(from, to, share) {
    const counts = new Uint32Array(this.none + 1);
    for (let i = from; i < to; ++i) ++counts[this.levels[i]];
    const all = to - from - counts[this.none];
    if (all === 0) return null;
    const at = wanted => {
      let level = 0;
      for (let seen = counts[0]; seen <= wanted; seen += counts[level]) ++level;
      return this.value(level);
    };
    return [at(Math.round(share * (all - 1))), at(Math.round((1 - share) * (all - 1)))];
  }
}

// history.csv: names, and the numbers of each column.
async function readHistory() {
  const history = report.history;
  const exact = new Float64Array(await chunk(history.exact)), rounded = new Float32Array(await chunk(history.rounded));
  const columns = new Map();
  const next = {exact: 0, rounded: 0};
  for (const column of history.columns) {
    const kind = column.exact ? 'exact' : 'rounded', source = column.exact ? exact : rounded;
    columns.set(column.name, source.subarray(next[kind], next[kind] + history.rows));
    next[kind] += history.rows;
  }
  return {rows: history.rows, columns};
}

function bodyName(number) { return report.bodies[number] ?? 'body ' + number; }
function materialName(number) { return report.materials[number] ?? 'material ' + number; }
