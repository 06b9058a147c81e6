// Colour maps, the same as in the pictures of a run.

// Lightness rises evenly (after viridis, CC0).
const SEQUENTIAL = [0x440154, 0x472d7b, 0x3b518b, 0x2c718e, 0x21918d, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725];
// Blue over near white to red: lightness is symmetric about the middle.
const DIVERGING = [0x16315f, 0x2f63a8, 0x6f9fd0, 0xb5cfe6, 0xf2f1ee, 0xecc3ae, 0xd98870, 0xb54646, 0x70162e];
const BODIES = [0x1e69b4, 0xe15a0f, 0x00c369, 0xe187f0, 0x78004b, 0x0f4b00, 0xffc300, 0x4bc3ff, 0x78785a, 0x2dffe1,
  0x964bb4, 0xd2b4b4, 0x3c1e96, 0x008700, 0x7887ff, 0x3c3c4b, 0x963c1e, 0xa5f069, 0xb49600, 0xff7896,
  0x00a5a5, 0xc33c78, 0xa587b4, 0x006969, 0xff965a, 0xffc3ff, 0x96d2a5, 0x875a78];
const NO_NUMBER = [150, 150, 150];

function rgb(hex) { return [hex >> 16 & 255, hex >> 8 & 255, hex & 255]; }
function css(colour) { return `rgb(${colour[0]} ${colour[1]} ${colour[2]})`; }
// As a pixel of an image: red is the first byte.
function pixel(colour) { return (255 << 24 | colour[2] << 16 | colour[1] << 8 | colour[0]) >>> 0; }

function interpolated(map, place) {
  const x = Math.min(Math.max(place, 0), 1) * (map.length - 1), i = Math.min(Math.floor(x), map.length - 2);
  const from = rgb(map[i]), to = rgb(map[i + 1]);
  return from.map((c, k) => Math.round(c + (x - i) * (to[k] - c)));
}

// A linear scale over a range; about zero and symmetric when the values take both signs.
function colourScale(lower, upper) {
  const oneValue = !(upper > lower);
  if (oneValue) {
    const margin = Math.abs(upper) > 0 ? 0.05 * Math.abs(upper) : 1;
    lower -= margin;
    upper += margin;
  }
  const size = Math.max(-lower, upper), trace = 0.1 * size;
  const diverging = !oneValue && lower < -trace && upper > trace;
  if (diverging) { lower = -size; upper = size; }
  const map = diverging ? DIVERGING : SEQUENTIAL;
  return {lower, upper, diverging,
    colour: value => Number.isNaN(value) ? NO_NUMBER : interpolated(map, (value - lower) / (upper - lower))};
}

function bodyColour(number) { return rgb(BODIES[number % BODIES.length]); }
