// Particles in the plane, drawn as their deformed domains by filling spans of pixels: crisp at any zoom, without gaps
// between neighbours, quick for 100,000 of them, and the particle under the pointer is known from its pixel.

const LEFT = 62;  // pixels of the page, for usual numbers beside the box

class PlaneView {
  constructor(box, frames) {
    this.frames = frames;
    this.canvas = element('canvas', {tabindex: 0, 'aria-label': 'particles'});
    box.append(this.canvas);
    this.raster = document.createElement('canvas');
    this.centre = [0, 0];
    this.scale = 1;  // pixels of the page a metre
    this.left = LEFT;
    this.whole = frames.box;
    this.pointer = null;
    this.listen();
    this.fit();
    let first = true;
    new ResizeObserver(() => { if (first) this.fit(); first = false; this.draw(); }).observe(this.canvas);
  }

  // The box within its labels, of which those of its left may be wide.
  plot() {
    return {left: this.left, top: 26, right: this.canvas.clientWidth - 20, bottom: this.canvas.clientHeight - 42};
  }

  // To all frames, or to the one that is shown.
  fit(box = this.whole) {
    const [[x0, y0], [x1, y1]] = box;
    this.centre = [(x0 + x1) / 2, (y0 + y1) / 2];
    this.left = LEFT;
    for (let k = 0; k < 2; ++k) {  // the numbers of the axes follow from the scale, and the room beside them
      this.fill(x1 - x0, y1 - y0);
      this.makeRoom(this.canvas.getContext('2d'));
    }
    this.draw();
  }

  fill(width, height) {
    const p = this.plot();
    this.scale = Math.min((p.right - p.left) / width, (p.bottom - p.top) / height);
  }

  toPage(x, y) {
    const p = this.plot();
    return [(p.left + p.right) / 2 + (x - this.centre[0]) * this.scale, (p.top + p.bottom) / 2 - (y - this.centre[1]) * this.scale];
  }
  fromPage(px, py) {
    const p = this.plot();
    return [this.centre[0] + (px - (p.left + p.right) / 2) / this.scale, this.centre[1] - (py - (p.top + p.bottom) / 2) / this.scale];
  }

  // colours: a pixel for every particle
  show(frame, colours) {
    this.frame = frame;
    this.colours = colours;
    this.draw();
  }

  draw() {
    if (!this.colours || this.canvas.clientWidth === 0) return;
    const {context: c, width, height, ratio} = fitCanvas(this.canvas);
    this.makeRoom(c);
    const p = this.plot();
    c.clearRect(0, 0, width, height);
    c.fillStyle = themeColour('canvas');
    c.fillRect(p.left, p.top, p.right - p.left, p.bottom - p.top);
    this.fillParticles(ratio);
    c.imageSmoothingEnabled = false;
    c.drawImage(this.raster, p.left, p.top, this.raster.width / ratio, this.raster.height / ratio);
    this.drawLines(c, p);
    this.drawAxes(c, p);
  }

  // Cracks of the frame, over what they part.
  drawLines(c, p) {
    const lines = this.frames.linesOf(this.frame);
    if (lines.length === 0) return;
    c.save();
    c.beginPath();
    c.rect(p.left, p.top, p.right - p.left, p.bottom - p.top);
    c.clip();
    c.lineJoin = 'round';
    for (const [colour, width] of [['#ffffff', 3], ['#000000', 1.25]]) {
      c.strokeStyle = colour;
      c.lineWidth = width;
      for (const line of lines) {
        c.beginPath();
        line.forEach(([x, y], k) => k === 0 ? c.moveTo(...this.toPage(x, y)) : c.lineTo(...this.toPage(x, y)));
        c.stroke();
      }
    }
    c.restore();
  }

  fillParticles(ratio) {
    const p = this.plot(), wide = Math.max(1, Math.round((p.right - p.left) * ratio)), high = Math.max(1, Math.round((p.bottom - p.top) * ratio));
    if (this.raster.width !== wide || this.raster.height !== high) {
      this.raster.width = wide;
      this.raster.height = high;
      this.picked = new Int32Array(wide * high);
      this.image = new ImageData(wide, high);
    }
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.pixels.fill(0);
    this.picked.fill(-1);
    const scale = this.scale * ratio, [cx, cy] = this.centre, frames = this.frames, edges = new Float64Array(4);
    const near = this.usualSize() * scale >= 6;
    for (let i = 0; i < frames.count; ++i) {
      const x = frames.place(0, this.frame, i), y = frames.place(1, this.frame, i);
      if (Number.isNaN(x) || Number.isNaN(y) || this.colours[i] === 0) continue;
      const px = wide / 2 + (x - cx) * scale, py = high / 2 - (y - cy) * scale;
      frames.halfEdges(this.frame, i, edges);
      const ax = edges[0] * scale, ay = -edges[2] * scale, bx = edges[1] * scale, by = -edges[3] * scale;
      const size = Math.sqrt(Math.min(ax * ax + ay * ay, bx * bx + by * by));
      const outer = 1 + 0.3 / Math.max(size, 0.3);  // slits thinner than a pixel would show as dots
      if (!near) {
        this.fillDomain(px, py, ax * outer, ay * outer, bx * outer, by * outer, this.colours[i], i);
        continue;
      }
      // From near, neighbours of one colour are told apart by a rim.
      const inner = 1 - Math.min(0.9 * ratio, 0.12 * size) / size;
      this.fillDomain(px, py, ax * outer, ay * outer, bx * outer, by * outer, darker(this.colours[i]), i);
      this.fillDomain(px, py, ax * inner, ay * inner, bx * inner, by * inner, this.colours[i], i);
    }
    this.outlineBodies(wide, high);
    this.raster.getContext('2d').putImageData(this.image, 0, 0);
  }

  // Half the side of a domain, m: a mean over some of the particles.
  usualSize() {
    const frames = this.frames, stride = Math.ceil(frames.count / 500), edges = new Float64Array(4);
    let sum = 0, count = 0;
    for (let i = 0; i < frames.count; i += stride) {
      frames.halfEdges(this.frame, i, edges);
      const area = Math.abs(edges[0] * edges[3] - edges[1] * edges[2]);
      if (!(area > 0)) continue;
      sum += Math.sqrt(area);
      ++count;
    }
    return count > 0 ? sum / count : 0;
  }

  // A thin line where two bodies meet, whatever their colours.
  outlineBodies(wide, high) {
    const {picked, pixels} = this, bodies = this.frames.bodies, line = pixel([40, 40, 40]);
    for (let row = 0; row + 1 < high; ++row)
      for (let at = row * wide, end = at + wide - 1; at < end; ++at) {
        if (picked[at] < 0) continue;
        const body = bodies[picked[at]];
        for (const next of [at + 1, at + wide])
          if (picked[next] >= 0 && bodies[picked[next]] !== body) pixels[at] = line;
      }
  }

  // The pixels whose middle is centre + s a + t b with |s|, |t| <= 1: of a row, where two strips meet. One at least.
  fillDomain(px, py, ax, ay, bx, by, colour, particle) {
    const wide = this.raster.width, high = this.raster.height;
    const reachX = Math.abs(ax) + Math.abs(bx), reachY = Math.abs(ay) + Math.abs(by), area = Math.abs(ax * by - ay * bx);
    if (px + reachX < 0 || px - reachX > wide || py + reachY < 0 || py - reachY > high) return;
    const mx = Math.floor(px), my = Math.floor(py);
    if (mx >= 0 && mx < wide && my >= 0 && my < high) {
      this.pixels[my * wide + mx] = colour;
      this.picked[my * wide + mx] = particle;
    }
    const top = Math.max(0, Math.ceil(py - reachY - 0.5)), bottom = Math.min(high - 1, Math.floor(py + reachY - 0.5));
    for (let row = top; row <= bottom; ++row) {
      const dy = row + 0.5 - py;
      let left = -reachX, right = reachX;
      for (let k = 0; k < 2; ++k) {
        const ex = k === 0 ? ax : bx, ey = k === 0 ? ay : by;
        if (Math.abs(ey) < 1e-9) {
          if (Math.abs(dy * ex) > area) right = left - 1;
          continue;
        }
        const middle = dy * ex / ey, half = area / Math.abs(ey);
        left = Math.max(left, middle - half);
        right = Math.min(right, middle + half);
      }
      const from = Math.max(0, Math.ceil(px + left - 0.5)), to = Math.min(wide - 1, Math.floor(px + right - 0.5));
      for (let at = row * wide + from, end = row * wide + to; at <= end; ++at) {
        this.pixels[at] = colour;
        this.picked[at] = particle;
      }
    }
  }

  // The ticks of the axes that are shown, and the unit of lengths.
  ticks(p) {
    const [x0, y1] = this.fromPage(p.left, p.top), [x1, y0] = this.fromPage(p.right, p.bottom);
    const unit = displayUnit(Math.max(Math.abs(x0), Math.abs(x1), Math.abs(y0), Math.abs(y1)), 'm');
    return {unit, across: roundTicks(x0 / unit.size, x1 / unit.size, (p.right - p.left) / 95),
      up: roundTicks(y0 / unit.size, y1 / unit.size, (p.bottom - p.top) / 60)};
  }

  // As wide a left margin as the numbers and the name of the axis need; never a narrower one, or a drag would shake it.
  makeRoom(c) {
    c.font = '12px ' + getComputedStyle(document.body).fontFamily;
    const {unit, up} = this.ticks(this.plot());
    const texts = [`y (${unit.name})`, ...up.at.map(tick => tickLabel(tick, up.spacing))];
    this.left = Math.max(this.left, 13 + Math.ceil(Math.max(...texts.map(text => c.measureText(text).width))));
  }

  drawAxes(c, p) {
    const {unit, across, up} = this.ticks(p);
    c.strokeStyle = themeColour('line');
    c.lineWidth = 1;
    c.strokeRect(p.left - 0.5, p.top - 0.5, p.right - p.left + 1, p.bottom - p.top + 1);
    c.fillStyle = themeColour('soft');
    c.strokeStyle = themeColour('soft');
    c.font = '12px ' + getComputedStyle(document.body).fontFamily;
    c.textAlign = 'center';
    c.textBaseline = 'top';
    for (const tick of across.at) {
      const px = Math.round(this.toPage(tick * unit.size, 0)[0]) + 0.5;
      c.beginPath(); c.moveTo(px, p.bottom); c.lineTo(px, p.bottom + 5); c.stroke();
      const text = tickLabel(tick, across.spacing), half = c.measureText(text).width / 2;
      c.fillText(text, Math.min(px, this.canvas.clientWidth - half - 1), p.bottom + 8);
    }
    c.textAlign = 'right';
    c.fillText(`${report.axisymmetric ? 'r' : 'x'} (${unit.name})`, p.right, p.bottom + 25);
    c.textBaseline = 'middle';
    for (const tick of up.at) {
      const py = Math.round(this.toPage(0, tick * unit.size)[1]) + 0.5;
      c.beginPath(); c.moveTo(p.left - 5, py); c.lineTo(p.left, py); c.stroke();
      c.fillText(tickLabel(tick, up.spacing), p.left - 9, py);
    }
    c.textBaseline = 'top';
    c.fillText(`${report.axisymmetric ? 'z' : 'y'} (${unit.name})`, p.left - 9, 3);
  }

  // The particle under a place of the canvas, or -1.
  pick(px, py) {
    const p = this.plot(), ratio = window.devicePixelRatio || 1;
    const x = Math.floor((px - p.left) * ratio), y = Math.floor((py - p.top) * ratio);
    if (!this.picked || x < 0 || y < 0 || x >= this.raster.width || y >= this.raster.height) return -1;
    return this.picked[y * this.raster.width + x];
  }

  // Where a particle is on the canvas.
  find(particle) { return this.toPage(this.frames.place(0, this.frame, particle), this.frames.place(1, this.frame, particle)); }

  listen() {
    let from = null;
    this.canvas.addEventListener('pointerdown', event => {
      from = [event.clientX, event.clientY];
      this.canvas.setPointerCapture(event.pointerId);
      this.canvas.style.cursor = 'grabbing';
    });
    this.canvas.addEventListener('pointermove', event => {
      if (!from) return;
      this.centre[0] -= (event.clientX - from[0]) / this.scale;
      this.centre[1] += (event.clientY - from[1]) / this.scale;
      from = [event.clientX, event.clientY];
      this.later();
    });
    for (const end of ['pointerup', 'pointercancel'])
      this.canvas.addEventListener(end, () => { from = null; this.canvas.style.cursor = ''; });
    this.canvas.addEventListener('dblclick', () => this.fit());
    this.canvas.addEventListener('wheel', event => {
      event.preventDefault();
      const room = this.canvas.getBoundingClientRect(), px = event.clientX - room.left, py = event.clientY - room.top;
      const [x, y] = this.fromPage(px, py);
      this.scale *= Math.exp(-0.0015 * event.deltaY);
      const [nx, ny] = this.fromPage(px, py);
      this.centre[0] += x - nx;
      this.centre[1] += y - ny;
      this.later();
    }, {passive: false});
  }

  later() { drawSoon(this); }
}

function darker(colour) {
  return (0xff000000 | (colour >> 16 & 255) * 0.72 << 16 | (colour >> 8 & 255) * 0.72 << 8 | (colour & 255) * 0.72) >>> 0;
}
