// The card of the particles: frames, time, field, range, and what lies under the pointer.

const OUTLIERS = 0.01;  // the share of the values at each end that the colours leave out, as in the pictures

class Player {
  constructor(frames) {
    this.frames = frames;
    this.frame = frames.times.length - 1;
    this.range = 'all';
    this.pixels = new Uint32Array(frames.count);
    this.picture = element('div', {class: 'picture', id: 'picture'});
    this.tip = element('div', {class: 'tip', id: 'tip', hidden: true});
    this.key = new ColourKey(() => this.chooseRange(this.range === 'extremes' ? 'all' : 'extremes'));
    this.bodies = new BodyList([...new Set(frames.bodies)].sort((a, b) => a - b), () => this.view && this.go(this.frame, false));
    this.makeControls();
    this.root = element('section', {class: 'card', id: 'particles'}, element('h2', {}, 'Particles'), this.controls,
      element('div', {class: 'stage'}, this.picture, this.key.root), this.bodies.root, this.slides, this.notes = element('ul', {class: 'notes'}));
    try {
      this.view = frames.dimension === 3 ? new SpaceView(this.picture, frames) : new PlaneView(this.picture, frames);
    } catch (error) {
      this.picture.replaceChildren(element('p', {class: 'message', id: 'no-webgl'},
        'The particles cannot be shown here: this browser has no WebGL 2, or it is switched off. ParaView opens particles.pvd.'));
    }
    this.picture.append(this.tip);
    this.listen();
  }

  makeControls() {
    const names = [...this.frames.fields.map(field => field.name), ...NAMED_FIELDS];
    this.fieldName = [report.picture, 'von_mises', names[0]].find(name => names.includes(name));
    this.play = element('button', {class: 'main', id: 'play', onclick: () => this.toggle()}, '\u25b6 Play');
    this.slider = element('input', {type: 'range', id: 'frame', min: 0, max: this.frames.times.length - 1, value: this.frame, 'aria-label': 'frame',
      oninput: () => { this.stop(); this.go(Number(this.slider.value)); }});
    this.time = element('span', {class: 'time', id: 'time'});
    const field = select(names.map(name => [name, fieldLabel(name)]), this.fieldName, name => this.choose(name));
    field.id = 'field';
    this.fieldList = field;
    this.rangeList = select([['all', 'of all frames'], ['frame', 'of this frame'], ['extremes', 'all, with outliers']], 'all', range => this.chooseRange(range));
    this.rangeList.id = 'range';
    this.controls = element('div', {class: 'bar'}, element('label', {}, 'colour', field), this.rangeLabel = element('label', {}, 'range', this.rangeList),
      element('span', {class: 'grow'}), element('button', {id: 'fit-frame', onclick: () => this.view?.fit(this.frames.boundingBox(this.frame)), title: 'show all of this frame'}, 'Fit frame'),
      element('button', {id: 'fit', onclick: () => this.view?.fit(), title: 'show all of every frame (double click)'}, 'Fit all'));
    this.slides = element('div', {class: 'bar', style: 'margin:12px 0 0'}, this.play, element('span', {class: 'grow'}, this.slider), this.time);
  }

  async choose(name) {
    this.fieldName = this.fieldList.value = name;
    const column = NAMED_FIELDS.includes(name) ? null : await this.frames.field(name);
    if (this.fieldName !== name) return;  // another one was chosen meanwhile
    this.column = column;
    this.rangeLabel.hidden = column === null;
    this.colour();
  }

  chooseRange(range) {
    this.range = this.rangeList.value = range;
    this.colour();
  }

  // To begin with: the last frame, or where little is left to see in it (all came to rest, or left) the one with most.
  tellingFrame() {
    const last = this.frames.times.length - 1, n = this.frames.count;
    if (!this.column || runStatus() !== 'finished') return last;
    const spread = this.frames.times.map((_, frame) => {
      const [lower, upper] = this.column.range(frame * n, (frame + 1) * n, 0.05) ?? [0, 0];
      return upper - lower;
    });
    const most = Math.max(...spread);
    return spread[last] >= most / 2 ? last : spread.indexOf(most);
  }

  numbers() { return this.fieldName === 'body' ? this.frames.bodies : this.frames.materials; }

  // The range of the colours; then all that depends on it.
  colour() {
    if (this.column) {
      const n = this.frames.count, all = this.column.levels.length;
      const [from, to] = this.range === 'frame' ? [this.frame * n, (this.frame + 1) * n] : [0, all];
      const within = share => this.column.range(from, to, share) ?? [0, 1];
      this.shown = within(this.range === 'extremes' ? 0 : OUTLIERS);
      if (this.shown[0] === this.shown[1]) this.shown = within(0);  // most are one value
      this.scale = colourScale(...this.shown);
      this.table = new Uint32Array(this.column.none + 1);
      const last = this.column.table ? this.column.table.length : this.column.none;
      for (let level = 0; level < last; ++level) this.table[level] = pixel(this.scale.colour(this.column.value(level)));
      this.table[this.column.none] = pixel(NO_NUMBER);
    }
    this.drawKey();
    this.go(this.frame, false);
  }

  go(frame, recolour = true) {
    this.frame = frame;
    this.slider.value = frame;
    const last = this.frames.times[this.frames.times.length - 1], unit = displayUnit(last, 's'), digits = Math.max(0, 3 - Math.ceil(Math.log10(last / unit.size || 1)));
    this.time.textContent = `${(this.frames.times[frame] / unit.size).toFixed(digits)} ${unit.name} \u00b7 ${frame + 1}/${this.frames.times.length}`;
    if (recolour && this.range === 'frame' && this.column) return this.colour();
    this.note();
    if (!this.view) return;
    const n = this.frames.count;
    if (this.column) {
      const levels = this.column.levels, table = this.table, from = frame * n;
      for (let i = 0; i < n; ++i) this.pixels[i] = table[levels[from + i]];
    } else {
      const numbers = this.numbers();
      for (let i = 0; i < n; ++i) this.pixels[i] = pixel(bodyColour(numbers[i]));
    }
    for (let i = 0; i < n; ++i) if (!this.bodies.shows(this.frames.bodies[i])) this.pixels[i] = 0;
    this.view.show(frame, this.pixels);
    this.hover();
  }

  toggle() {
    if (this.timer) return this.stop();
    if (!this.played || this.frame + 1 >= this.frames.times.length) this.go(0);
    this.played = true;
    const wait = Math.min(200, Math.max(50, 5000 / this.frames.times.length));
    this.play.textContent = '\u275a\u275a Pause';
    this.timer = setInterval(() => this.frame + 1 < this.frames.times.length ? this.go(this.frame + 1) : this.stop(), wait);
  }
  stop() {
    clearInterval(this.timer);
    this.timer = null;
    this.play.textContent = '\u25b6 Play';
  }

  drawKey() {
    if (this.column) {
      const [lower, upper] = this.shown, where = this.range === 'frame' ? 'in this frame' : 'everywhere';
      if (lower === upper) return this.key.oneValue(fieldLabel(this.fieldName), valueText(lower, this.column.unit), where);
      return this.key.bar(fieldLabel(this.fieldName), this.column.unit, this.scale, this.range === 'extremes');
    }
    const name = this.fieldName === 'body' ? bodyName : materialName, present = [...new Set(this.numbers())].sort((a, b) => a - b);
    this.key.names(present.map(number => [bodyColour(number), name(number)]));
  }

  listen() {
    this.picture.addEventListener('pointermove', event => {
      const room = this.picture.getBoundingClientRect();
      this.pointer = event.buttons ? null : [event.clientX - room.left, event.clientY - room.top];
      this.hover();
    });
    this.picture.addEventListener('pointerleave', () => { this.pointer = null; this.hover(); });
    this.root.addEventListener('keydown', event => {
      if (event.target.closest('select, input, button')) return;
      const steps = {ArrowLeft: -1, ArrowRight: 1};
      if (event.key === ' ') this.toggle();
      else if (event.key in steps) { this.stop(); this.go(Math.min(Math.max(this.frame + steps[event.key], 0), this.frames.times.length - 1)); }
      else return;
      event.preventDefault();
    });
  }

  // The values of the particle under the pointer.
  hover() {
    const particle = this.pointer && this.view ? this.view.pick(...this.pointer) : -1;
    this.hovered = particle < 0 ? null : this.describe(particle);
    if (!this.hovered) { this.tip.hidden = true; return; }
    const {id, body, material, place, value} = this.hovered, axes = report.axisymmetric ? 'rz' : 'xyz', lines = element('table', {});
    const line = (name, text) => lines.append(element('tr', {}, element('td', {}, name), element('td', {}, text)));
    line('body', bodyName(body));
    if (report.materials.length > 1) line('material', materialName(material));
    place.forEach((x, d) => line(axes[d], valueText(x, 'm', 5)));
    if (this.column) line(fieldLabel(this.fieldName), valueText(value, this.column.unit, this.column.bits === 16 ? 5 : 3));
    this.tip.replaceChildren(element('b', {}, 'particle ' + id), lines);
    placeTip(this.tip, ...this.pointer);
  }

  describe(particle) {
    const at = this.frame * this.frames.count + particle;
    return {particle, id: this.frames.id(particle), body: this.frames.bodies[particle], material: this.frames.materials[particle],
      place: this.frames.axes.map((column, d) => this.frames.place(d, this.frame, particle)),
      value: this.column ? this.column.value(this.column.levels[at]) : this.numbers()[particle]};
  }

  // What the page leaves out and how far its numbers may be off.
  note() {
    const notes = [...report.notices], places = this.frames.axes[0].rounding();
    const field = this.column ? `, ${fieldLabel(this.fieldName)} within ${this.column.table ? 'at most ' : ''}${valueText(this.column.rounding(), this.column.unit, 2)}` : '';
    notes.push(`Rounded for this page: places within ${valueText(places, 'm', 2)}${field}. The particle files hold all digits.`);
    if (this.view) notes.push(this.frames.dimension === 3 ? 'Balls have the volume that a particle began with. Drag to turn, shift-drag to move, wheel to zoom.' :
      'Drag to move, wheel to zoom, space to play, arrow keys for single frames.');
    if (this.view && !this.bodies.root.hidden) notes.push('A click on the name of a body hides it or shows it again, a double click shows it alone.');
    this.notes.replaceChildren(...notes.map(text => element('li', {}, text)));
  }
}
