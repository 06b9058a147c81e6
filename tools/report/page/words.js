// What a run says of itself: its ending, figures, warnings, passes and scene.

const STATUS_TEXT = {finished: 'finished', failed: 'failed', stopped: 'stopped', open: 'not ended'};

function runStatus() {
  return report.run ? report.run.status ?? 'open' : 'open';
}

function heading() {
  const run = report.run ?? {}, status = runStatus();
  const parts = [];
  if (run.dimension) parts.push(run.dimension === 3 ? '3-D' : report.axisymmetric ? 'axisymmetric' : '2-D');
  if (run.particles !== undefined) parts.push(`${run.particles.toLocaleString('en')} particles`);
  if (run.steps !== undefined) parts.push(`${run.steps.toLocaleString('en')} steps to ${timeText(run.time_s)}`);
  if (run.wall_s !== undefined) parts.push(`${valueText(run.wall_s, 's', 3)} of wall time on ${run.threads} thread${run.threads === 1 ? '' : 's'}`);
  return element('header', {}, element('h1', {}, report.title),
    element('p', {class: 'under'}, element('span', {class: 'pill ' + status, id: 'status'}, STATUS_TEXT[status] ?? status), parts.join(' \u00b7 ')));
}

// Why it did not come to its end, before all else.
function endingCard() {
  const status = runStatus(), run = report.run;
  if (status === 'finished') return null;
  const lines = [];
  if (!run) lines.push('There is no run.json: the run goes on now, or was killed. What it has written so far is shown; mpmfast resume may carry it on.');
  else if (run.reason === 'signal') lines.push('A signal ended it: Ctrl-C, kill, or a terminal that was closed.');
  else if (run.reason === 'request') lines.push('The program that ran it asked it to stop.');
  else if (run.reason) lines.push(run.reason);
  if (status === 'failed' && report.failed_file) lines.push('failed.vtu holds the particles around the place of the failure, with all that a frame has.');
  if (status === 'stopped') lines.push('mpmfast resume carries it on from its checkpoint.');
  const title = status === 'failed' ? 'The run failed' : status === 'stopped' ? 'The run was stopped' : 'The run has not ended';
  return element('section', {class: `card reason ${status}`, id: 'ending'}, element('h2', {}, title),
    ...lines.map((line, k) => element('p', {class: k === 0 ? 'cause' : 'under'}, line)));
}

function warningsCard() {
  const warnings = report.run?.warnings ?? [];
  if (warnings.length === 0) return null;
  return element('section', {class: 'card reason stopped', id: 'warnings'}, element('h2', {}, 'Worth a second look'),
    element('ul', {class: 'warnings'}, ...warnings.map(text => element('li', {}, text))));
}

function memoryText(bytes) { return bytes > 0 ? `${significant(bytes / 1048576, 4)} MiB at most` : undefined; }

function figuresCard() {
  const run = report.run;
  if (!run) return null;
  const rows = [['command', run.command && element('code', {}, run.command)], ['program', `mpmfast ${run.version} (${run.git})`],
    ['compiler', `${run.compiler}, ${run.flags}`], ['processor', run.cpu], ['threads', run.threads], ['wall time', valueText(run.wall_s, 's')],
    ['speed', `${significant(run.particle_steps_per_s / 1e6, 3)} million particle-steps a second`], ['memory', memoryText(run.peak_memory_bytes)],
    ['time step', run.dt_min_s > 0 ? `${timeText(run.dt_min_s)} to ${timeText(run.dt_max_s)}` : undefined],
    ['velocity fields', run.fields], ['active nodes', run.nodes_active_peak && `${run.nodes_active_peak.toLocaleString('en')} at most`],
    ['left the grid', run.outflow && `${run.outflow.particles.toLocaleString('en')} particles with ${valueText(run.outflow.kg, shownUnit('kg'))} and ${valueText(run.outflow.J, shownUnit('J'))}`],
    ['resumed', run.resumes > 0 ? `${run.resumes} times` : undefined], ['checksum', run.checksum && element('code', {}, run.checksum)]];
  return element('section', {class: 'card', id: 'figures'}, element('h2', {}, 'The run'), facts(rows));
}

function contactCard() {
  const contact = report.run?.contact;
  if (!contact || !contact.nodes_peak) return null;
  const whole = value => value?.toLocaleString('en'), share = (part, all) => all > 0 ? ` (${significant(100 * part / all, 2)} %)` : '';
  const rows = [['contact nodes', `${whole(contact.nodes_peak)} at most`], ['normals fitted', whole(contact.regressions)],
    ['iterations', `${significant(contact.mean_iterations, 3)} in the mean`],
    ['did not converge', whole(contact.unconverged) + share(contact.unconverged, contact.regressions)],
    ['fell back', whole(contact.fallbacks) + share(contact.fallbacks, contact.regressions)],
    ['of surfaces that touch or overlap', contact.touching ? whole(contact.touching) : undefined],
    ['of these doubtful', contact.touching ? whole(contact.doubtful) + share(contact.doubtful, contact.touching) : undefined],
    ['screened', contact.meetings !== undefined ? whole(contact.screened) + share(contact.screened, contact.meetings) : undefined],
    ['nodes of pairs', contact.pair_nodes ? whole(contact.pair_nodes) : undefined],
    ['pairs left to the lump', contact.pair_nodes ? whole(contact.pair_fallbacks) + share(contact.pair_fallbacks, contact.pair_nodes) : undefined]];
  return element('section', {class: 'card', id: 'contact'}, element('h2', {}, 'Contact'), facts(rows));
}

function passesCard() {
  const passes = Object.entries(report.run?.seconds ?? {}).filter(([, seconds]) => seconds > 0);  // those that ran
  if (passes.length === 0) return null;
  const wall = report.run.wall_s, most = Math.max(...passes.map(([, seconds]) => seconds));
  const table = element('table', {class: 'facts passes', id: 'passes'});
  for (const [name, seconds] of passes)
    table.append(element('tr', {}, element('td', {}, name.replaceAll('_', ' ')), element('td', {}, valueText(seconds, 's', 3)),
      element('td', {}, wall > 0 ? `${(100 * seconds / wall).toFixed(1)} %` : ''),
      element('td', {}, element('div', {class: 'share', style: `width:${most > 0 ? 100 * seconds / most : 0}%`}))));
  return element('section', {class: 'card'}, element('h2', {}, 'Seconds by pass'), table);
}

function sceneCard() {
  return element('section', {class: 'card', id: 'scene'}, element('details', {},
    element('summary', {}, 'The scene, with every default written out'), element('pre', {}, report.scene)));
}
