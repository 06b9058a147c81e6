// Particles in space as shaded balls, drawn by WebGL: drag to turn, shift-drag to move, wheel to zoom.

const BALL_VERTEX = `#version 300 es
in vec3 place; in float radius; in vec4 colour;
uniform mat4 view; uniform mat4 projection; uniform float pixels;
out vec4 tint; out vec3 centre; out float size;
void main() {
  vec4 seen = view * vec4(place, 1.0);
  gl_Position = projection * seen;
  tint = colour; centre = seen.xyz; size = radius;
  gl_PointSize = max(1.5, 2.0 * radius * pixels / -seen.z);
  if (colour.a < 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;
const BALL_FRAGMENT = `#version 300 es
precision highp float;
in vec4 tint; in vec3 centre; in float size;
uniform mat4 projection;
out vec4 shade;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  float away = dot(at, at);
  if (away > 1.0) discard;
  vec3 normal = vec3(at.x, -at.y, sqrt(1.0 - away));
  float light = 0.62 + 0.38 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.55, 0.8))));
  shade = vec4(tint.rgb * light, 1.0);
  vec4 front = projection * vec4(centre + size * normal, 1.0);
  gl_FragDepth = 0.5 * front.z / front.w + 0.5;
}`;
const LINE_VERTEX = `#version 300 es
in vec3 place; uniform mat4 view; uniform mat4 projection;
void main() { gl_Position = projection * view * vec4(place, 1.0); }`;
const LINE_FRAGMENT = `#version 300 es
precision mediump float;
uniform vec4 colour; out vec4 shade;
void main() { shade = colour; }`;

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error('WebGL: ' + gl.getProgramInfoLog(made));
  return made;
}

class SpaceView {
  // Throws where there is no WebGL.
  constructor(box, frames) {
    this.frames = frames;
    this.canvas = element('canvas', {tabindex: 0, 'aria-label': 'particles'});
    this.over = element('canvas', {class: 'over'});
    const gl = this.canvas.getContext('webgl2', {antialias: true, preserveDrawingBuffer: true});
    if (!gl) throw new Error('no WebGL');
    this.gl = gl;
    this.balls = program(gl, BALL_VERTEX, BALL_FRAGMENT);
    this.lines = program(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.buffers = {place: gl.createBuffer(), radius: gl.createBuffer(), colour: gl.createBuffer(), line: gl.createBuffer()};
    box.append(this.canvas, this.over);
    // Lengths in units of the box: WebGL counts in single precision.
    const [lower, upper] = frames.box;
    this.middle = lower.map((x, d) => (x + upper[d]) / 2);
    this.unit = Math.hypot(...lower.map((x, d) => upper[d] - x)) / 2 || 1;
    this.half = lower.map((x, d) => (upper[d] - x) / 2 / this.unit);  // of the box around them
    this.places = new Float32Array(3 * frames.count);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.radius);
    gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(frames.sideX, side => 1.15 * side / 2 / this.unit), gl.STATIC_DRAW);
    this.listen();
    this.fit();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  // As the pictures: from the front right and above, z up.
  // To all frames, or to the one that is shown.
  fit(box = this.frames.box) {
    Object.assign(this, {azimuth: -0.55, elevation: 0.42, shift: [0, 0], fitted: box, fittedTo: null});
    this.look = box[0].map((x, d) => ((x + box[1][d]) / 2 - this.middle[d]) / this.unit);
    this.distance = 3;
    this.draw();
  }

  // As near as the canvas, which may have changed, still shows all that was fitted; until someone moves it.
  comeNear() {
    const size = `${this.canvas.clientWidth} ${this.canvas.clientHeight}`, box = this.fitted;
    if (!box || this.fittedTo === size) return;
    this.fittedTo = size;
    const radius = Math.hypot(...box[0].map((x, d) => box[1][d] - x)) / 2 / this.unit || 1;
    let near = 1.02 * radius, far = 12 * Math.min(1, radius);  // further in, a corner may be behind the eye
    for (let k = 0; k < 24; ++k) {
      this.distance = (near + far) / 2;
      if (this.centre()) far = this.distance; else near = this.distance;
    }
    this.distance = far;
    this.centre();
  }

  // Moves what was fitted to the middle of the canvas. Does all of it show?
  centre() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight, margin = 8;
    this.shift = [0, 0];
    for (let k = 0; ; ++k) {  // what is nearer moves faster: again
      this.matrices();
      const [left, right, top, bottom] = this.outline();
      if (k === 3) return left >= margin && right <= width - margin && top >= margin && bottom <= height - margin;
      this.shift[0] += (width - left - right) * this.distance / this.projection[0] / width;
      this.shift[1] -= (height - top - bottom) * this.distance / this.projection[5] / height;
    }
  }

  // Of what was fitted, and of its labels where it is all: left, right, top, bottom, in CSS pixels.
  outline() {
    const x = [], y = [], c = this.labelContext();
    for (let corner = 0; corner < 8; ++corner) {
      const [px, py] = this.project(...this.middle.map((middle, d) => (this.fitted[corner >> d & 1][d] - middle) / this.unit));
      x.push(px);
      y.push(py);
    }
    if (this.fitted === this.frames.box)
      for (const label of this.labels()) {
        const half = c.measureText(label.text).width / 2;
        x.push(label.x - half, label.x + half);
        y.push(label.y - 7, label.y + 7);
      }
    return [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)];
  }

  show(frame, colours) {
    this.frame = frame;
    this.colours = new Uint32Array(colours);
    const gl = this.gl;
    for (let i = 0; i < this.frames.count; ++i) {
      for (let d = 0; d < 3; ++d) this.places[3 * i + d] = (this.frames.place(d, frame, i) - this.middle[d]) / this.unit;
      if (Number.isNaN(this.places[3 * i])) { this.colours[i] = 0; this.places.fill(0, 3 * i, 3 * i + 3); }
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.place);
    gl.bufferData(gl.ARRAY_BUFFER, this.places, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.colour);
    gl.bufferData(gl.ARRAY_BUFFER, new Uint8Array(this.colours.buffer), gl.DYNAMIC_DRAW);
    this.draw();
  }

  // Column by column: the eye looks along -z at the turned and moved box.
  matrices() {
    const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth), ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
    const right = [ca, -sa, 0], up = [-se * -sa, -se * -ca, ce];
    const back = [right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2], right[0] * up[1] - right[1] * up[0]];
    const along = axis => axis[0] * this.look[0] + axis[1] * this.look[1] + axis[2] * this.look[2];
    this.view = new Float32Array([right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
      this.shift[0] - along(right), this.shift[1] - along(up), -this.distance - along(back), 1]);
    const aspect = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight), f = 1 / Math.tan(0.31);
    const near = Math.max(0.02, this.distance - 2.5), far = this.distance + 2.5;
    const narrow = Math.min(1, aspect);
    this.projection = new Float32Array([f / aspect * narrow, 0, 0, 0, 0, f * narrow, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0]);
  }

  // Where a point (in units of the box) is on the canvas, in CSS pixels, and how far from the eye.
  project(x, y, z) {
    const v = this.view, sx = v[0] * x + v[4] * y + v[8] * z + v[12], sy = v[1] * x + v[5] * y + v[9] * z + v[13], sz = v[2] * x + v[6] * y + v[10] * z + v[14];
    return [(this.projection[0] * sx / -sz + 1) / 2 * this.canvas.clientWidth, (1 - this.projection[5] * sy / -sz) / 2 * this.canvas.clientHeight, -sz];
  }

  draw() {
    if (!this.colours || this.canvas.clientWidth === 0) return;
    const gl = this.gl, ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    this.comeNear();
    this.matrices();
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...this.theme('canvas'));
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawBalls(gl);
    this.drawBox(gl);
    this.drawLabels();
  }

  drawBalls(gl) {
    gl.useProgram(this.balls);
    this.uniforms(gl, this.balls);
    gl.uniform1f(gl.getUniformLocation(this.balls, 'pixels'), this.projection[5] * this.canvas.height / 2);
    this.attribute(gl, this.balls, 'place', 3, gl.FLOAT);
    this.attribute(gl, this.balls, 'radius', 1, gl.FLOAT);
    this.attribute(gl, this.balls, 'colour', 4, gl.UNSIGNED_BYTE);
    gl.drawArrays(gl.POINTS, 0, this.frames.count);
  }

  uniforms(gl, used) {
    gl.uniformMatrix4fv(gl.getUniformLocation(used, 'view'), false, this.view);
    gl.uniformMatrix4fv(gl.getUniformLocation(used, 'projection'), false, this.projection);
  }

  attribute(gl, used, name, size, type) {
    const at = gl.getAttribLocation(used, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name]);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, type, type === gl.UNSIGNED_BYTE, 0, 0);
  }

  drawBox(gl) {
    const ends = [];
    for (let c = 0; c < 8; ++c)
      for (let d = 0; d < 3; ++d)
        if ((c >> d & 1) === 0) for (const e of [c, c | 1 << d]) ends.push(...this.half.map((h, k) => e >> k & 1 ? h : -h));
    for (const name of ['place', 'radius', 'colour']) gl.disableVertexAttribArray(gl.getAttribLocation(this.balls, name));
    gl.useProgram(this.lines);
    this.uniforms(gl, this.lines);
    gl.uniform4fv(gl.getUniformLocation(this.lines, 'colour'), this.theme('line'));
    const at = gl.getAttribLocation(this.lines, 'place');
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.line);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(ends), gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 0, 0);
    gl.drawArrays(gl.LINES, 0, ends.length / 3);
  }

  labelContext() {
    const {context} = fitCanvas(this.over);
    context.font = '12px ' + getComputedStyle(document.body).fontFamily;
    return context;
  }

  drawLabels() {
    const c = this.labelContext();
    c.clearRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    c.fillStyle = themeColour('soft');
    c.textAlign = 'center';
    c.textBaseline = 'middle';
    for (const {text, x, y} of this.labels()) c.fillText(text, x, y);
  }

  // Ticks along the three lower edges that bound the box on the screen.
  labels() {
    const all = [];
    const unit = displayUnit(Math.max(...this.frames.box.flat().map(Math.abs)), 'm');
    const middle = this.project(0, 0, 0);
    for (let d = 0; d < 3; ++d) {
      const edge = this.labelledEdge(d), lower = this.frames.box[0][d], upper = this.frames.box[1][d];
      const ticks = roundTicks(lower / unit.size, upper / unit.size, 4);
      const label = (place, text, away) => {
        const point = edge.slice();
        point[d] = (place - this.middle[d]) / this.unit;
        const [x, y] = this.project(...point), dx = x - middle[0], dy = y - middle[1], far = Math.hypot(dx, dy) || 1;
        all.push({text, x: x + away * dx / far, y: y + away * dy / far});
      };
      for (const tick of ticks.at) label(tick * unit.size, tickLabel(tick, ticks.spacing), 16);
      label((lower + upper) / 2, `${'xyz'[d]} (${unit.name})`, 50);
    }
    return all;
  }

  // Of the four edges along an axis: for x and y the lower one that is nearer, for z the one furthest to the left.
  labelledEdge(d) {
    let best = null, least = Infinity;
    for (let c = 0; c < 8; ++c) {
      if (c >> d & 1 || (d < 2 && c >> 2 & 1)) continue;
      const point = this.half.map((h, k) => k === d ? 0 : c >> k & 1 ? h : -h), [x, , away] = this.project(...point);
      const cost = d < 2 ? away : x;
      if (cost < least) { least = cost; best = point; }
    }
    return best;
  }

  theme(name) {
    const c = document.createElement('canvas').getContext('2d');
    c.fillStyle = themeColour(name);
    const hex = parseInt(c.fillStyle.slice(1), 16);
    return [...rgb(hex).map(v => v / 255), 1];
  }

  pick(px, py) {
    if (!this.view) return -1;
    const pixels = this.projection[5] * this.canvas.clientHeight / 2;
    let best = -1, least = Infinity;
    for (let i = 0; i < this.frames.count; ++i) {
      if (this.colours[i] === 0) continue;
      const [x, y, away] = this.project(this.places[3 * i], this.places[3 * i + 1], this.places[3 * i + 2]);
      const radius = Math.max(2, 1.15 * this.frames.sideX[i] / 2 / this.unit * pixels / away);
      if (away < least && away > 0 && (x - px) ** 2 + (y - py) ** 2 <= radius * radius) { least = away; best = i; }
    }
    return best;
  }

  find(particle) { return this.project(...this.places.subarray(3 * particle, 3 * particle + 3)); }

  listen() {
    let from = null;
    this.canvas.addEventListener('pointerdown', event => { from = [event.clientX, event.clientY]; this.canvas.setPointerCapture(event.pointerId); });
    this.canvas.addEventListener('pointermove', event => {
      if (!from) return;
      const dx = event.clientX - from[0], dy = event.clientY - from[1];
      from = [event.clientX, event.clientY];
      this.fitted = null;
      if (event.shiftKey || event.buttons === 2) {
        const step = this.distance / this.projection[5] / this.canvas.clientHeight * 2;
        this.shift = [this.shift[0] + dx * step, this.shift[1] - dy * step];
      } else {
        this.azimuth += 0.008 * dx;
        this.elevation = Math.min(1.55, Math.max(-1.55, this.elevation + 0.008 * dy));
      }
      this.later();
    });
    for (const end of ['pointerup', 'pointercancel']) this.canvas.addEventListener(end, () => { from = null; });
    this.canvas.addEventListener('contextmenu', event => event.preventDefault());
    this.canvas.addEventListener('dblclick', () => this.fit());
    this.canvas.addEventListener('wheel', event => {
      event.preventDefault();
      this.fitted = null;
      this.distance = Math.min(12, Math.max(0.15, this.distance * Math.exp(0.0012 * event.deltaY)));
      this.later();
    }, {passive: false});
  }

  later() { drawSoon(this); }
}
