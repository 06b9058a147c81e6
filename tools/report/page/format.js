// Numbers for people: units of a sensible size, round ticks, and the small pieces that the page is built of.

const PREFIXES = [['T', 1e12], ['G', 1e9], ['M', 1e6], ['k', 1e3], ['', 1], ['m', 1e-3], ['\u00b5', 1e-6], ['n', 1e-9]];

// Of this run: "J/m" for J where it is a metre of a plane.
function shownUnit(unit) { return report.units[unit] ?? unit; }

// Nobody writes ks, Mm or mPa.
function usualPrefix(prefix, unit) {
  if (unit === 'Pa' || unit === 'Pa \u221am') return ['T', 'G', 'M', 'k', ''].includes(prefix);
  if (['J', 'N', 'J/m', 'N/m', 'J/m^2', 'J/m^3', 'W'].includes(unit)) return prefix !== 'n';
  if (unit === 'm' && prefix === 'k') return true;
  return ['', 'm', '\u00b5', 'n'].includes(prefix);
}

// The unit of the same quantity in which `size` has one to three digits before the point, and its size in SI.
// Lengths have one unit on the whole page.
function displayUnit(size, unit) {
  if (unit === 'm' && report.length) return report.length;
  if (!['m', 's', 'Pa', 'Pa \u221am', 'J', 'N', 'J/m', 'N/m', 'W', 'J/m^2', 'J/m^3'].includes(unit) || !(size > 0) || !isFinite(size))
    return {name: prettyUnit(unit), size: 1};
  let smallest = {name: prettyUnit(unit), size: 1};
  for (const [prefix, factor] of PREFIXES) {
    if (!usualPrefix(prefix, unit)) continue;
    smallest = {name: prefix + prettyUnit(unit), size: factor};
    if (size >= 0.9995 * factor) break;
  }
  return smallest;
}

function prettyUnit(unit) {
  return unit.replace('^2', '\u00b2').replace('^3', '\u00b3').replaceAll('*', '\u00b7');
}

function significant(value, digits = 4) {
  if (value === null || Number.isNaN(value)) return 'no number';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4)
    return value.toExponential(digits - 1).replace(/\.?0+e/, 'e').replace('e+', 'e').replace('-', '\u2212').replace('e-', 'e\u2212');
  return String(Number(value.toPrecision(digits))).replace('-', '\u2212');
}

function valueText(value, unit, digits = 4) {
  if (!isFinite(value)) return 'no number';
  const shown = displayUnit(Math.abs(value), unit);
  return significant(value / shown.size, digits) + (shown.name ? ' ' + shown.name : '');
}

function timeText(seconds, digits = 4) {
  return seconds === 0 ? '0 s' : valueText(seconds, 's', digits);
}

// Round numbers (1, 2, 5 x 10^n apart) between two, about `wanted` of them.
function roundTicks(lower, upper, wanted) {
  const width = upper - lower;
  if (!(width > 0) || !isFinite(width)) return {at: [], spacing: 1};
  const raw = width / Math.max(wanted, 1), decade = 10 ** Math.floor(Math.log10(raw));
  let spacing = 10 * decade;
  for (const step of [5, 2, 1]) if (step * decade >= 0.7 * raw) spacing = step * decade;
  const at = [];
  for (let n = Math.ceil(lower / spacing - 1e-9); n <= upper / spacing + 1e-9 && at.length < 100; ++n) at.push(n * spacing);
  return {at, spacing};
}

function tickLabel(tick, spacing) {
  if (Math.abs(tick) < 1e-6 * spacing) return '0';
  if (spacing < 1e-4 || Math.abs(tick) >= 1e6) return significant(tick, 6);
  const decimals = Math.max(0, -Math.floor(Math.log10(spacing) + 1e-9));
  return tick.toFixed(decimals).replace('-', '\u2212');
}

// element('p', {class: 'hint'}, 'text', child…): an element of the page.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, '');
    else if (value !== false && value !== undefined && value !== null) made.setAttribute(name, value);
  }
  made.append(...children.filter(child => child !== null && child !== undefined));
  return made;
}

function select(options, chosen, changed) {
  const list = element('select', {onchange: () => changed(list.value)});
  for (const [value, text] of options) list.append(element('option', {value, selected: value === chosen}, text));
  return list;
}

function facts(rows) {
  const table = element('table', {class: 'facts'});
  for (const [name, value] of rows)
    if (value !== undefined && value !== null && value !== '') table.append(element('tr', {}, element('td', {}, name), element('td', {}, value)));
  return table;
}

function themeColour(name) { return getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim(); }

// A canvas of as many pixels as the screen has under it. Returns its context, in CSS pixels, and its size.
function fitCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  const wide = Math.max(1, Math.round(width * ratio)), high = Math.max(1, Math.round(height * ratio));
  if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return {context, width, height, ratio};
}

// A tip beside a place of its parent, kept inside it.
function placeTip(tip, x, y) {
  tip.hidden = false;
  const room = tip.parentElement.getBoundingClientRect(), size = tip.getBoundingClientRect();
  const left = x + 16 + size.width > room.width ? x - 16 - size.width : x + 16;
  tip.style.left = Math.max(0, left) + 'px';
  tip.style.top = Math.max(0, Math.min(y + 14, room.height - size.height)) + 'px';
}

// Draws a view once before the screen is drawn next, however often it is asked to.
function drawSoon(view) {
  if (view.waits) return;
  view.waits = true;
  requestAnimationFrame(() => { view.waits = false; view.draw(); });
}
