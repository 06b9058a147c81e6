// Puts the page together.

async function build() {
  const page = document.getElementById('page');
  const add = card => { if (card) page.append(card); };
  add(heading());
  add(endingCard());
  add(warningsCard());
  const place = page.appendChild(element('div', {}));
  const history = await readHistory();
  const histories = history.rows > 0 ? new Histories(history) :
    {root: element('section', {class: 'card', id: 'histories'}, element('h2', {}, 'Histories'), element('p', {class: 'under'}, 'The history has no row yet.'))};
  add(histories.root);
  add(energyCard(history));
  const columns = element('div', {class: 'columns'}), left = element('div', {}), right = element('div', {});
  for (const [side, card] of [[left, passesCard()], [left, contactCard()], [right, figuresCard()]]) if (card) side.append(card);
  columns.append(...[left, right].filter(side => side.childElementCount > 0));
  if (columns.childElementCount > 0) add(columns);
  add(sceneCard());
  add(element('p', {class: 'hint'}, `Made by ${report.program} from the folder ${report.folder}. The page holds all it needs: it can be kept, sent and opened anywhere.`));
  if (report.frames) {
    const player = new Player(await Frames.read(report.frames));
    place.append(player.root);
    window.player = player;
    await player.choose(player.fieldName);
    player.go(player.tellingFrame());
    player.view?.fit();
  } else {
    place.append(element('section', {class: 'card', id: 'particles'}, element('h2', {}, 'Particles'),
      ...report.notices.map(text => element('p', {class: 'under'}, text))));
  }
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    histories.chart?.draw();
    window.player?.drawKey();
    window.player?.view?.draw();
  });
  document.body.dataset.ready = 'yes';
}

build().catch(error => {
  document.getElementById('page').prepend(element('section', {class: 'card reason'}, element('h2', {}, 'This page could not be drawn'),
    element('p', {}, typeof DecompressionStream === 'undefined' ? 'It needs a browser of 2023 or later.' : String(error))));
  throw error;
});
