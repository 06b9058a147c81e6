// The energy balance, as run.json's energy_error: what there is, was turned to heat or left, less the work that came
// in, against its first value; relative to the largest energy so far.

function energyBalance(history) {
  const column = name => history.columns.get(name) ?? new Float64Array(history.rows);
  const [kinetic, stored, dissipated, friction, bonds, gone, boundary, body, heat] = ['kinetic_J', 'stored_J', 'dissipated_J',
    'friction_J', 'interface_J', 'outflow_J', 'boundary_work_J', 'body_force_work_J', 'expansion_work_J'].map(column);
  const error = new Float64Array(history.rows);
  let first = 0, scale = 0;
  for (let i = 0; i < history.rows; ++i) {
    const balance = kinetic[i] + stored[i] + dissipated[i] + friction[i] + bonds[i] + gone[i] - boundary[i] - body[i] - heat[i];
    if (i === 0) first = balance;
    scale = Math.max(scale, kinetic[i] + stored[i] + dissipated[i], Math.abs(boundary[i]), Math.abs(body[i]));
    error[i] = scale > 0 ? (balance - first) / scale : 0;
  }
  return error;
}

function energyWords(history, error) {
  const last = history.rows - 1, first = 0;
  const most = Math.max(...['kinetic_J', 'stored_J', 'boundary_work_J'].map(name => Math.abs(history.columns.get(name)?.[last] ?? 0)));
  const change = name => {
    const column = history.columns.get(name);
    const change = column ? column[last] - column[first] : 0;
    return Math.abs(change) > 1e-9 * most ? change : 0;  // the rest is round-off
  };
  const energy = joule => valueText(Math.abs(joule), shownUnit('J'), 3);
  const parts = [], came = change('boundary_work_J') + change('body_force_work_J');
  if (came !== 0) parts.push(came > 0 ? `Boundaries and body forces put ${energy(came)} in.` : `Boundaries and body forces took ${energy(came)} out.`);
  const expanded = change('expansion_work_J'), warmed = change('heat_in_J');
  if (expanded !== 0) parts.push(`Heat that stretched the bodies ${expanded > 0 ? 'put' : 'took'} ${energy(expanded)} ${expanded > 0 ? 'in' : 'out'}.`);
  if (warmed !== 0) parts.push(`${energy(warmed)} of heat came ${warmed > 0 ? 'in' : 'out'} through faces and given nodes.`);
  const where = [['kinetic_J', 'kinetic energy'], ['stored_J', 'stored energy']]
    .map(([name, text]) => [change(name), text]).filter(([joule]) => joule !== 0)
    .map(([joule, text]) => `${text} ${joule > 0 ? 'rose' : 'fell'} by ${energy(joule)}`);
  if (where.length > 0) parts.push(where.join(', ').replace(/^./, c => c.toUpperCase()) + '.');
  const lost = [['friction_J', 'to friction'], ['dissipated_J', 'to plastic work and viscous heat'], ['interface_J', 'to bonds that broke'], ['outflow_J', 'with particles that left']]
    .map(([name, text]) => [change(name), text]).filter(([joule]) => joule !== 0).map(([joule, text]) => `${energy(joule)} went ${text}`);
  if (lost.length > 0) parts.push(lost.join(', ') + '.');
  const off = error[last];
  parts.push(Math.abs(off) < 1e-9 ? 'The balance closes to round-off.' :
    `The balance is off by ${significant(100 * off, 3)} % of the energy at work: the method ${off < 0 ? 'lost' : 'made'} as much.`);
  return parts.join(' ');
}

function energyCard(history) {
  if (history.rows < 1) return null;
  const error = energyBalance(history), chart = new LineChart(true);
  chart.show({x: history.columns.get('time_s'), curves: [{name: 'error of the balance', y: error.map(e => 100 * e)}],
    xName: 'time', xUnit: 's', yName: 'error', yUnit: '%'});
  chart.legend.hidden = true;
  return element('section', {class: 'card', id: 'energy'}, element('h2', {}, 'Energy balance'),
    element('p', {class: 'words', style: 'margin:0 0 10px'}, energyWords(history, error)), chart.root);
}
