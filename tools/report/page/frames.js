// The frames of a run: where particles are and of what shape, and the fields, unpacked when they are chosen.

const WIDER = 0.05;

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

  // Half of the edges of a domain, m: F by its undeformed sides, row by row; as large as the pictures draw it.
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
    this.limit(out, x, y);
  }

  // What is too large is drawn as it was seeded. Where domains follow F it is drawn as shape functions take it: what is too
  // long or too thin as the rectangle of the same second moments, cut to the largest half-diagonal (as the pictures do).
  limit(out, x, y) {
    const [a, b, c, d] = out, most = this.largest ** 2;
    if (!(most > 0)) return;
    const first = a * a + c * c, second = b * b + d * d, dot = a * b + c * d, det = a * d - b * c;
    const long = first + second + 2 * Math.abs(dot) > most;
    if (!this.follows_shape) {
      if (long) [out[0], out[1], out[2], out[3]] = [x, 0, 0, y];
      return;
    }
    if (!long && Math.abs(det) >= this.least_sine * Math.sqrt(first * second)) return;
    const angle = Math.atan2(2 * dot, first - second) / 2;  // from the first edge to the one that becomes the long axis
    const rx = Math.cos(angle) * a + Math.sin(angle) * b, ry = Math.cos(angle) * c + Math.sin(angle) * d;
    const longer = rx * rx + ry * ry, shorter = det * det / longer;
    const shortKept = Math.min(shorter, most / 2), longKept = Math.min(longer, most - shortKept);
    const scale = Math.sqrt(longKept / longer), aside = shorter > 0 ? Math.sqrt(shortKept / shorter) * det / longer : 0;
    [out[0], out[1], out[2], out[3]] = [scale * rx, -aside * ry, scale * ry, aside * rx];
  }

  // How far a particle reaches along an axis, m.
  reach(axis, frame, particle, edges) {
    if (this.dimension === 3) return this.sideX[particle] / 2;
    this.halfEdges(frame, particle, edges);
    return Math.abs(edges[2 * axis]) + Math.abs(edges[2 * axis + 1]);
  }

  // Of all particles, in all frames or in one, with their domains; wider by so much of its longest side, as in the pictures.
  boundingBox(frame) {
    const [first, last] = frame === undefined ? [0, this.times.length - 1] : [frame, frame];
    const lower = [], upper = [], edges = new Float64Array(4);
    let side = 0;
    for (const x of this.sideX) side = Math.max(side, x);
    const furthest = Math.max(this.largest ?? Infinity, side);  // nobody reaches further
    for (let axis = 0; axis < this.axes.length; ++axis) {
      let least = Infinity, most = -Infinity;
      for (let f = first; f <= last; ++f)
        for (let i = 0; i < this.count; ++i) {
          const x = this.place(axis, f, i);
          if (!(x - furthest < least || x + furthest > most)) continue;
          const reach = this.reach(axis, f, i, edges);
          least = Math.min(least, x - reach);
          most = Math.max(most, x + reach);
        }
      if (!(least <= most)) { least = 0; most = 1; }
      lower.push(least);
      upper.push(most);
    }
    for (let d = 0; d < lower.length; ++d) if (!(upper[d] > lower[d])) { lower[d] -= 0.5; upper[d] += 0.5; }
    const margin = WIDER / 2 * Math.max(...lower.map((x, d) => upper[d] - x));
    for (let d = 0; d < lower.length; ++d) { lower[d] -= margin; upper[d] += margin; }
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
