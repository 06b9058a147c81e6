// The frames of a run: where particles are and of what shape, and the fields, unpacked when they are chosen.

class Frames {
  static async read(described) {
    const frames = new Frames();
    Object.assign(frames, described);
    frames.fieldCache = new Map();
    frames.ids = described.ids === undefined ? null : new Uint32Array(await chunk(described.ids));
    frames.bodies = new Uint16Array(await chunk(described.body));
    frames.materials = new Uint16Array(await chunk(described.material));
    frames.sideX = new Float32Array(await chunk(described.side_x));
    frames.sideY = new Float32Array(await chunk(described.side_y));
    frames.axes = await Promise.all(described.places.map(column => Column.read(column, described.count)));
    frames.shapes = described.gradient ? await Promise.all(described.gradient.map(column => Column.read(column, described.count))) : null;
    frames.box = frames.boundingBox();
    return frames;
  }

  id(particle) { return this.ids ? this.ids[particle] : particle; }
  place(axis, frame, particle) {
    const column = this.axes[axis], level = column.levels[frame * this.count + particle];
    return level === column.none ? NaN : column.lower + column.spacing * level;
  }

  // The cracks of a frame, each a list of places.
  linesOf(frame) {
    const [x, y] = this.axes, lines = [];
    for (const steps of this.lines?.[frame] ?? []) {
      const line = [];
      for (let k = 0; k + 1 < steps.length; k += 2) line.push([x.lower + x.spacing * steps[k], y.lower + y.spacing * steps[k + 1]]);
      lines.push(line);
    }
    return lines;
  }

  // Half of the edges of a domain, m: F by its undeformed sides, row by row.
  halfEdges(frame, particle, out) {
    const x = this.sideX[particle] / 2, y = this.sideY[particle] / 2;
    out[0] = x; out[1] = 0; out[2] = 0; out[3] = y;
    if (!this.shapes) return;
    const at = frame * this.count + particle, f = this.shapes;
    if (f[0].levels[at] === f[0].none) return;
    out[0] = f[0].value(f[0].levels[at]) * x;
    out[1] = f[1].value(f[1].levels[at]) * y;
    out[2] = f[2].value(f[2].levels[at]) * x;
    out[3] = f[3].value(f[3].levels[at]) * y;
  }

  // Of all particles, in all frames or in one, with half a particle around.
  boundingBox(frame) {
    const [from, to] = frame === undefined ? [0, this.axes[0].levels.length] : [frame * this.count, (frame + 1) * this.count];
    const lower = [], upper = [];
    let side = 0;
    for (const x of this.sideX) side = Math.max(side, x);
    for (const column of this.axes) {
      let least = Infinity, most = -Infinity;
      for (let i = from; i < to; ++i) {
        const level = column.levels[i];
        if (level === column.none) continue;
        if (level < least) least = level;
        if (level > most) most = level;
      }
      if (!(least <= most)) { least = 0; most = 1; }
      lower.push(column.value(least) - side / 2);
      upper.push(column.value(most) + side / 2);
    }
    for (let d = 0; d < lower.length; ++d) if (!(upper[d] > lower[d])) { lower[d] -= 0.5; upper[d] += 0.5; }
    return [lower, upper];
  }

  // A column by its name; those of bodies and materials have names for numbers.
  async field(name) {
    if (!this.fieldCache.has(name)) {
      const described = this.fields.find(field => field.name === name);
      this.fieldCache.set(name, Column.read(described, this.count));
    }
    return this.fieldCache.get(name);
  }
}

const NAMED_FIELDS = ['body', 'material'];

function fieldLabel(name) {
  const known = {von_mises: 'von Mises stress', volume_ratio: 'volume ratio J'};
  return known[name] ?? name.replaceAll('_', ' ');
}
