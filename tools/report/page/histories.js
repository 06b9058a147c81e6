// The card of the histories: the usual charts, or any columns against any other.

const USUAL = [
  {name: 'energies', label: 'energy', unit: 'J', matches: name => name.endsWith('_J')},
  {name: 'mean stress', label: 'mean stress', unit: 'Pa', matches: name => name.includes('.mean_stress_')},
  {name: 'stress against strain', label: 'mean stress', unit: 'Pa', matches: name => name.includes('.mean_stress_'), against: name => name.endsWith('.strain')},
  {name: 'forces', label: 'force', unit: 'N', matches: name => name.includes('.force_')},
  {name: 'momentum', label: 'momentum', unit: 'kg m/s', matches: name => name.startsWith('momentum_')},
  {name: 'velocities', label: 'velocity', unit: 'm/s', matches: name => /\.v[xyz]$/.test(name)},
  {name: 'time step', label: 'time step', unit: 's', matches: name => name === 'dt_s'}];
const isThere = (usual, names) => names.some(usual.matches) && (!usual.against || names.some(usual.against));
const MOST_CURVES = 10;  // more cannot be told apart

function columnUnit(name) {
  const units = [[/_m2$/, 'm^2'], [/_Pa$/, 'Pa'], [/_J$/, 'J'], [/_Nm$/, 'N m'], [/_N$/, 'N'], [/_kg$/, 'kg'], [/_m$/, 'm'], [/_s$/, 's'],
    [/momentum_[xyz]$/, 'kg m/s'], [/\.v[xyz]$/, 'm/s']];
  return units.find(([end]) => end.test(name))?.[1] ?? '';
}

function columnLabel(name) {
  return name.replace(/_(m2|Pa|J|Nm|N|kg|m|s)$/, '').replaceAll('_', ' ');
}

class Histories {
  constructor(history) {
    this.history = history;
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
    let names = this.names.filter(usual.matches);
    const telling = names.filter(name => this.history.columns.get(name).some(value => value !== 0));
    if (telling.length > 0) names = telling;
    const together = names.filter(name => name.startsWith('all.'));
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
