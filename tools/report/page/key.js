// What the colours of the particles mean: a bar with numbers, the one value of a field, or names.

class ColourKey {
  // all: called by the button that takes outliers in, or leaves them out again
  constructor(all) {
    this.canvas = element('canvas', {});
    this.button = element('button', {id: 'outliers', onclick: all});
    this.root = element('div', {class: 'key', id: 'key'});
    new ResizeObserver(() => this.draw()).observe(this.root);
  }

  names(entries) {
    this.scale = null;
    this.root.replaceChildren(element('ul', {}, ...entries.map(([colour, name]) =>
      element('li', {}, element('span', {class: 'swatch', style: `background:${css(colour)}`}), name))));
  }

  oneValue(label, value, where) {
    this.scale = null;
    this.root.replaceChildren(element('p', {}, label), element('p', {class: 'under'}, `${value} ${where}`));
  }

  bar(label, unit, scale, outliers) {
    Object.assign(this, {label, unit, scale});
    this.button.textContent = outliers ? 'all values \u00b7 leave out outliers' : '1 to 99 % of the values \u00b7 show all';
    this.root.replaceChildren(this.canvas, this.button);
    this.draw();
  }

  draw() {
    if (!this.scale || !this.canvas.isConnected) return;
    const {context: c, width, height} = fitCanvas(this.canvas), top = 46, bottom = height - 12, wide = 20;
    c.clearRect(0, 0, width, height);
    if (bottom <= top) return;
    const {lower, upper, colour} = this.scale, at = value => bottom - (value - lower) / (upper - lower) * (bottom - top);
    for (let y = top; y < bottom; ++y) {
      c.fillStyle = css(colour(lower + (bottom - y - 0.5) / (bottom - top) * (upper - lower)));
      c.fillRect(0, y, wide, 1.5);
    }
    const unit = displayUnit(Math.max(Math.abs(lower), Math.abs(upper)), this.unit), ticks = roundTicks(lower / unit.size, upper / unit.size, (bottom - top) / 50);
    c.font = '12px ' + getComputedStyle(document.body).fontFamily;
    c.fillStyle = themeColour('soft');
    c.strokeStyle = themeColour('soft');
    c.textBaseline = 'middle';
    for (const tick of ticks.at) {
      const y = Math.round(at(tick * unit.size)) + 0.5;
      c.beginPath(); c.moveTo(wide, y); c.lineTo(wide + 4, y); c.stroke();
      c.fillText(tickLabel(tick, ticks.spacing), wide + 8, y);
    }
    c.fillStyle = themeColour('ink');
    c.textBaseline = 'top';
    c.fillText(this.label, 0, 4);
    c.fillStyle = themeColour('soft');
    if (unit.name) c.fillText('in ' + unit.name, 0, 21);
  }
}
