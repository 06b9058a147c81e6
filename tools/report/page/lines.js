// A chart of curves on a canvas: hover for values, drag to zoom in, wheel to zoom, double click for all of it. The
// legend beside it switches curves off and on.

const CURVES = ['#2f6db3', '#d9622b', '#2f9e68', '#a44fc0', '#c79a00', '#c2456e', '#00a0a8', '#7a6a55', '#6b7cf0', '#93a83a'];
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3]];  // from the second time round, so that no two look the same
const curveColour = k => CURVES[k % CURVES.length];
const curveDash = k => DASHES[Math.floor(k / CURVES.length) % DASHES.length];
// A short piece of the curve, as a background.
function swatchOf(k) {
  let at = 0;
  const stops = curveDash(k).map((length, i) => `${i % 2 ? 'transparent' : curveColour(k)} ${at}px ${at += length}px`);
  return stops.length > 0 ? `repeating-linear-gradient(90deg, ${stops.join(', ')})` : curveColour(k);
}

class LineChart {
  // curves: [{name, y}], x: numbers; labels: {x, y} with units {xUnit, yUnit}
  constructor(low = false) {
    this.canvas = element('canvas', {tabindex: 0, 'aria-label': 'chart'});
    this.tip = element('div', {class: 'tip', hidden: true});
    this.legend = element('div', {class: 'legend'});
    this.box = element('div', {class: low ? 'chart low' : 'chart'}, this.canvas, this.tip);
    this.root = element('div', {}, this.box, this.legend);
    this.off = new Set();
    this.curves = [];
    this.listen();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  show({x, curves, xName, xUnit, yName, yUnit}) {
    Object.assign(this, {x, curves, xName, xUnit, yName, yUnit, view: null, hover: null});
    this.legend.replaceChildren(...curves.map((curve, k) => {
      const entry = element('button', {class: this.off.has(curve.name) ? 'off' : '', title: 'show or hide', onclick: () => {
        if (!this.off.delete(curve.name)) this.off.add(curve.name);
        entry.classList.toggle('off', this.off.has(curve.name));
        if (!this.zoomed) this.view = null;
        this.draw();
      }}, element('span', {class: 'swatch', style: `background:${swatchOf(k)}`}), curve.name);
      return entry;
    }));
    this.zoomed = false;
    this.draw();
  }

  shown() { return this.curves.map((curve, k) => ({...curve, colour: curveColour(k), dash: curveDash(k)})).filter(c => !this.off.has(c.name)); }

  // All that the shown curves have, with a margin.
  whole() {
    const range = {x: [Infinity, -Infinity], y: [Infinity, -Infinity]};
    const include = (side, value) => {
      if (!isFinite(value)) return;
      side[0] = Math.min(side[0], value);
      side[1] = Math.max(side[1], value);
    };
    for (const value of this.x) include(range.x, value);
    for (const curve of this.shown()) for (const value of curve.y) include(range.y, value);
    for (const side of [range.x, range.y]) {
      if (!(side[0] <= side[1])) { side[0] = 0; side[1] = 1; }
      if (side[0] === side[1]) { const m = Math.abs(side[0]) * 0.05 || 1; side[0] -= m; side[1] += m; }
    }
    const margin = 0.04 * (range.y[1] - range.y[0]);
    range.y = [range.y[0] - margin, range.y[1] + margin];
    return range;
  }

  plot() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    return {left: 66, top: 26, right: width - 14, bottom: height - 40};
  }
  toX(x) { const p = this.plot(), [a, b] = this.view.x; return p.left + (x - a) / (b - a) * (p.right - p.left); }
  toY(y) { const p = this.plot(), [a, b] = this.view.y; return p.bottom - (y - a) / (b - a) * (p.bottom - p.top); }
  fromX(px) { const p = this.plot(), [a, b] = this.view.x; return a + (px - p.left) / (p.right - p.left) * (b - a); }
  fromY(py) { const p = this.plot(), [a, b] = this.view.y; return a + (p.bottom - py) / (p.bottom - p.top) * (b - a); }

  draw() {
    if (!this.x || this.canvas.clientWidth === 0) return;
    this.view ??= this.whole();
    const {context: c, width, height} = fitCanvas(this.canvas), p = this.plot();
    c.clearRect(0, 0, width, height);
    this.drawAxes(c, p);
    c.save();
    c.beginPath();
    c.rect(p.left, p.top, p.right - p.left, p.bottom - p.top);
    c.clip();
    c.lineWidth = 1.7;
    c.lineJoin = 'round';
    for (const curve of this.shown()) this.drawCurve(c, curve);
    c.restore();
    if (this.box_) this.drawBox(c);
    else if (this.hover) this.drawHover(c, p);
  }

  drawCurve(c, curve) {
    c.strokeStyle = c.fillStyle = curve.colour;
    c.beginPath();
    let open = false;
    for (let i = 0; i < this.x.length; ++i) {
      const px = this.toX(this.x[i]), py = this.toY(curve.y[i]);
      if (!isFinite(px) || !isFinite(py)) { open = false; continue; }
      if (open) c.lineTo(px, py); else c.moveTo(px, py);
      open = true;
    }
    c.setLineDash(curve.dash);
    c.stroke();
    c.setLineDash([]);
    if (this.x.length > 1) return;
    for (let i = 0; i < this.x.length; ++i) c.fillRect(this.toX(this.x[i]) - 3, this.toY(curve.y[i]) - 3, 6, 6);
  }

  drawAxes(c, p) {
    const ink = themeColour('soft'), line = themeColour('faint');
    c.font = '12px ' + getComputedStyle(document.body).fontFamily;
    c.fillStyle = ink;
    const axis = (range, unit, count, each, label) => {
      const shown = displayUnit(Math.max(Math.abs(range[0]), Math.abs(range[1])), unit);
      const ticks = roundTicks(range[0] / shown.size, range[1] / shown.size, count);
      for (const tick of ticks.at) each(tick * shown.size, tickLabel(tick, ticks.spacing));
      label(shown.name);
    };
    c.lineWidth = 1;
    axis(this.view.x, this.xUnit, (p.right - p.left) / 95, (x, text) => {
      const px = Math.round(this.toX(x)) + 0.5;
      c.strokeStyle = line;
      c.beginPath(); c.moveTo(px, p.top); c.lineTo(px, p.bottom); c.stroke();
      c.textAlign = 'center'; c.textBaseline = 'top';
      c.fillText(text, px, p.bottom + 6);
    }, unit => { c.textAlign = 'right'; c.textBaseline = 'top'; c.fillText(this.xName + (unit ? ` (${unit})` : ''), p.right, p.bottom + 23); });
    axis(this.view.y, this.yUnit, (p.bottom - p.top) / 48, (y, text) => {
      const py = Math.round(this.toY(y)) + 0.5;
      c.strokeStyle = Math.abs(y) < 1e-12 * (this.view.y[1] - this.view.y[0]) ? themeColour('line') : line;
      c.beginPath(); c.moveTo(p.left, py); c.lineTo(p.right, py); c.stroke();
      c.textAlign = 'right'; c.textBaseline = 'middle';
      c.fillText(text, p.left - 7, py);
    }, unit => { c.textAlign = 'left'; c.textBaseline = 'top'; c.fillText(this.yName + (unit ? ` (${unit})` : ''), 4, 3); });
    c.strokeStyle = themeColour('line');
    c.strokeRect(p.left + 0.5, p.top + 0.5, p.right - p.left - 1, p.bottom - p.top - 1);
  }

  // The row that is nearest to the pointer along x (and along y, where x goes to and fro).
  nearestRow() {
    let best = -1, least = Infinity;
    const curves = this.shown();
    for (let i = 0; i < this.x.length; ++i) {
      let away = Math.abs(this.toX(this.x[i]) - this.hover.x);
      if (curves.length > 0) away += 1e-3 * Math.min(...curves.map(curve => Math.abs(this.toY(curve.y[i]) - this.hover.y)));
      if (away < least) { least = away; best = i; }
    }
    return best;
  }

  drawHover(c, p) {
    const row = this.nearestRow();
    if (row < 0) return;
    const px = this.toX(this.x[row]);
    c.strokeStyle = themeColour('soft');
    c.lineWidth = 1;
    c.beginPath(); c.moveTo(px, p.top); c.lineTo(px, p.bottom); c.stroke();
    const curves = this.shown().sort((a, b) => b.y[row] - a.y[row]);
    for (const curve of curves) {
      c.fillStyle = curve.colour;
      c.beginPath(); c.arc(px, this.toY(curve.y[row]), 3.5, 0, 7); c.fill();
    }
    const lines = element('table', {});
    for (const curve of curves.slice(0, 12))
      lines.append(element('tr', {}, element('td', {style: `color:${curve.colour}`}, curve.name), element('td', {}, valueText(curve.y[row], this.yUnit, 5))));
    if (curves.length > 12) lines.append(element('tr', {}, element('td', {}, `and ${curves.length - 12} more`)));
    this.tip.replaceChildren(element('b', {}, `${this.xName} ${valueText(this.x[row], this.xUnit, 5)}`), lines);
    placeTip(this.tip, px, this.hover.y);
  }

  drawBox(c) {
    const {x0, y0, x1, y1} = this.box_;
    c.globalAlpha = 0.15;
    c.fillStyle = themeColour('accent');
    c.fillRect(x0, y0, x1 - x0, y1 - y0);
    c.globalAlpha = 1;
    c.strokeStyle = themeColour('accent');
    c.strokeRect(x0, y0, x1 - x0, y1 - y0);
  }

  listen() {
    const at = event => { const r = this.canvas.getBoundingClientRect(); return {x: event.clientX - r.left, y: event.clientY - r.top}; };
    this.canvas.addEventListener('pointerdown', event => {
      if (!this.view) return;
      const {x, y} = at(event);
      this.canvas.setPointerCapture(event.pointerId);
      this.box_ = {x0: x, y0: y, x1: x, y1: y};
      this.tip.hidden = true;
    });
    this.canvas.addEventListener('pointermove', event => {
      const {x, y} = at(event), p = this.plot();
      if (this.box_) { this.box_.x1 = x; this.box_.y1 = y; }
      else if (x > p.left && x < p.right) this.hover = {x, y};
      else this.leave();
      this.draw();
    });
    this.canvas.addEventListener('pointerup', () => this.zoomToBox());
    this.canvas.addEventListener('pointerleave', () => { this.leave(); this.draw(); });
    this.canvas.addEventListener('dblclick', () => { this.view = null; this.zoomed = false; this.draw(); });
    this.canvas.addEventListener('wheel', event => {
      if (!this.view || !(event.ctrlKey || document.activeElement === this.canvas)) return;  // else the page scrolls
      event.preventDefault();
      const {x, y} = at(event), factor = Math.exp(0.0015 * event.deltaY), cx = this.fromX(x), cy = this.fromY(y);
      this.view = {x: this.view.x.map(v => cx + (v - cx) * factor), y: this.view.y.map(v => cy + (v - cy) * factor)};
      this.zoomed = true;
      this.draw();
    }, {passive: false});
  }

  leave() { this.hover = null; this.tip.hidden = true; }

  zoomToBox() {
    const box = this.box_;
    this.box_ = null;
    if (!box) return;
    if (Math.abs(box.x1 - box.x0) > 8 && Math.abs(box.y1 - box.y0) > 8) {
      const sorted = (a, b) => a < b ? [a, b] : [b, a];
      this.view = {x: sorted(this.fromX(box.x0), this.fromX(box.x1)), y: sorted(this.fromY(box.y0), this.fromY(box.y1))};
      this.zoomed = true;
    }
    this.draw();
  }
}
