// The card of the histories: the usual charts, or any columns against any other.

const USUAL = [
  {name: 'energies', label: 'energy', unit: 'J', matches: name => name.endsWith('_J')},
  {name: 'mean stress', label: 'mean stress', unit: 'Pa', matches: name => name.includes('.mean_stress_')},
  {name: 'stress against strain', label: 'mean stress', unit: 'Pa', matches: name => name.includes('.mean_stress_'), against: name => name.endsWith('.strain')},
  {name: 'forces', label: 'force', unit: 'N', matches: name => name.includes('.force_')},
  {name: 'stress intensities', label: 'stress intensity', unit: 'Pa \u221am', matches: name => /\.KI+_Pa_sqrt_m$/.test(name)},
  {name: 'crack lengths', label: 'length', unit: 'm', matches: name => name.endsWith('.length_m')},
  {name: 'momentum', label: 'momentum', unit: 'kg m/s', matches: name => name.startsWith('momentum_')},
  {name: 'velocities', label: 'velocity', unit: 'm/s', matches: name => /\.v[xyz]$/.test(name)},
  {name: 'time step', label: 'time step', unit: 's', matches: name => name === 'dt_s'}];
const isThere = (usual, names) => names.some(usual.matches) && (!usual.against || names.some(usual.against));
const MOST_CURVES = 10;  // more cannot be told apart

function columnUnit(name) {
  const units = [[/_Pa_sqrt_m$/, 'Pa \u221am'], [/_J_per_m2$/, 'J/m^2'], [/_m2$/, 'm^2'], [/_Pa$/, 'Pa'], [/_J$/, 'J'], [/_Nm$/, 'N m'], [/_N$/, 'N'], [/_kg$/, 'kg'], [/_m$/, 'm'], [/_s$/, 's'],
    [/momentum_[xyz]$/, 'kg m/s'], [/\.v[xyz]$/, 'm/s']];
  return shownUnit(units.find(([end]) => end.test(name))?.[1] ?? '');
}

function columnLabel(name) {
  return name.replace(/_(Pa_sqrt_m|J_per_m2|m2|Pa|J|Nm|N|kg|m|s)$/, '').replaceAll('_', ' ');
}

// Total momenta that are but round-off of what the bodies carry become zero.
function clearRoundOff(columns, rows) {
  const carried = new Float64Array(rows);
  for (const [name, mass] of columns) {
    if (!name.endsWith('.mass_kg') || name.startsWith('all.')) continue;
    for (const axis of 'xyz') columns.get(name.replace(/mass_kg$/, 'v' + axis))?.forEach((v, k) => { carried[k] += Math.abs(mass[k] * v); });
  }
  const least = 1e-9 * carried.reduce((most, p) => isFinite(p) ? Math.max(most, p) : most, 0);
  for (const axis of 'xyz') {
    const name = 'momentum_' + axis;
    if (columns.has(name)) columns.set(name, columns.get(name).map(p => Math.abs(p) < least ? 0 : p));
  }
}

// Are those of all bodies together those of the only one that has any?
function repeatsTheOnlyBody(columns, names) {
  const all = names.filter(name => name.startsWith('all.')), own = names.filter(name => !name.startsWith('all.'));
  return own.length > 0 && own.length === all.length && all.every(name => {
    const body = own.find(other => other.endsWith(name.slice(3)));
    if (!body) return false;
    const a = columns.get(body), b = columns.get(name);
    const largest = a.reduce((most, v) => Math.max(most, Math.abs(v)), 0);
    return a.every((v, k) => !(Math.abs(v - b[k]) > 1e-9 * largest));
  });
}

class Histories {
  constructor(history) {
    this.history = history;
    clearRoundOff(history.columns, history.rows);
    this.x = 'time_s';
    this.chart = new LineChart();
    this.names = [...history.columns.keys()];
    this.tabs = USUAL.filter(usual => isThere(usual, this.names)).map(usual =>
      [usual, element('button', {onclick: () => this.showUsual(usual)}, usual.name)]);
    this.chooseTab = element('button', {id: 'choose', onclick: () => this.choose()}, 'choose\u2026');
    this.chooser = element('div', {class: 'chooser', hidden: true});
    this.search = element('input', {type: 'search', oninput: () => this.filter()});
    this.finder = element('label', {hidden: true}, 'find', this.search);
    this.against = select(this.names.map(name => [name, columnLabel(name)]), this.x, name => { this.x = name; this.draw(); });
    this.root = element('section', {class: 'card', id: 'histories'}, element('h2', {}, 'Histories'),
      element('div', {class: 'bar'}, ...this.tabs.map(([, button]) => button), this.chooseTab, this.finder, element('span', {class: 'grow'}),
        element('label', {}, 'against', this.against)),
      this.chooser, this.chart.root,
      element('p', {class: 'hint'}, 'Drag to zoom in, double-click for everything; with the chart in focus the wheel zooms.'));
    if (this.tabs.length > 0) this.showUsual(this.tabs[0][0]);
  }

  press(button) {
    for (const [, other] of this.tabs) other.setAttribute('aria-pressed', other === button);
    this.chooseTab.setAttribute('aria-pressed', this.chooseTab === button);
    this.chooser.hidden = this.finder.hidden = button !== this.chooseTab;
  }

  // Of many bodies, what there is of all together.
  showUsual(usual) {
    this.press(this.tabs.find(([other]) => other === usual)[1]);
    const flat = !this.names.some(name => name.endsWith('.vz'));
    let names = this.names.filter(name => usual.matches(name) && !(flat && name === 'momentum_z'));
    const telling = names.filter(name => this.history.columns.get(name).some(value => value !== 0));
    if (telling.length > 0) names = telling;
    const together = names.filter(name => name.startsWith('all.'));
    if (repeatsTheOnlyBody(this.history.columns, names)) names = names.filter(name => !name.startsWith('all.'));
    if (names.length > MOST_CURVES && together.length > 0) names = together;
    this.chosen = names.slice(0, MOST_CURVES);
    this.label = usual.label;
    this.x = this.against.value = usual.against ? this.names.find(usual.against) : 'time_s';
    this.draw();
  }

  choose() {
    if (this.chooser.childElementCount === 0)
      for (const name of this.names)
        this.chooser.append(element('label', {}, element('input', {type: 'checkbox', value: name, onchange: () => this.pick()}), name));
    for (const box of this.chooser.querySelectorAll('input')) box.checked = this.chosen.includes(box.value);
    this.press(this.chooseTab);
    this.pick();
  }

  pick() {
    this.chosen = [...this.chooser.querySelectorAll('input:checked')].map(box => box.value);
    this.label = this.chosen.length === 1 ? columnLabel(this.chosen[0]) : '';
    this.draw();
  }

  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/);
    for (const label of this.chooser.children) label.hidden = !words.every(word => label.textContent.toLowerCase().includes(word));
  }

  draw() {
    const units = new Set(this.chosen.map(columnUnit));
    this.chart.show({x: this.history.columns.get(this.x), curves: this.chosen.map(name => ({name: columnLabel(name), y: this.history.columns.get(name)})),
      xName: columnLabel(this.x), xUnit: columnUnit(this.x), yName: this.label || 'value', yUnit: units.size === 1 ? [...units][0] : ''});
  }
}
