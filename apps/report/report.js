// SPDX-License-Identifier: MIT
'use strict';
(() => {
const data = JSON.parse(document.getElementById('data').textContent);

// Figures.
const absent = '–';
function figure(value) {
  if (value === null || value === undefined) return absent;
  if (value === 0) return '0';
  if (Math.abs(value) < 1e-4) return value.toExponential(1);
  return Math.abs(value) < 10 ? value.toFixed(4) : value.toFixed(1);
}
const milliseconds = value => value === null ? absent : value < 10 ? value.toFixed(2) : value.toFixed(1);
function bytes(value) {
  const units = ['B', 'KiB', 'MiB', 'GiB'];
  let unit = 0;
  while (value >= 1024 && unit < units.length - 1) { value /= 1024; ++unit; }
  return (unit ? value.toFixed(1) : value) + ' ' + units[unit];
}
const fullName = run => run.overrides ? `${run.recipe}, ${run.overrides.replaceAll(',', ', ')}` : run.recipe;
const nameOf = run => [run.recipe, run.overrides ? el('span', {class: 'override'}, ' ' + run.overrides.replaceAll(',', ', ')) : null];
const refusedLights = run => run.status === 'ok' ? run.lights.filter(light => light.status === 'refused') : [];
// One line a reason; reasons that differ in the light's own name only are one.
function groupedReasons(lights) {
  const groups = new Map();
  for (const light of lights) {
    const kind = light.reason.replace(`'${light.name}'`, "''");
    groups.set(kind, [...(groups.get(kind) || []), light]);
  }
  return [...groups.values()].map(group => {
    const names = group.slice(0, 3).map(light => `'${light.name}'`).join(', ') + (group.length > 3 ? ` and ${group.length - 3} more` : '');
    return `${group.length > 1 ? `${group.length} lights (${names})` : `light ${names}`}: ${group[0].reason}`;
  });
}
function shortOf(run) {
  const refused = refusedLights(run);
  return refused.length ? el('span', {class: 'status refused', title: groupedReasons(refused).join('\n')},
    `${run.lights.length - refused.length} of ${run.lights.length} lights`) : null;
}
const statusOf = item => el('span', {class: 'status ' + item.status}, item.status);

function command(text) {
  const code = el('code', {}, text);
  const copy = el('button', {type: 'button', 'aria-label': 'Copy the command', onclick: async () => {
    try { await navigator.clipboard.writeText(text); copy.textContent = 'Copied'; }
    catch { getSelection().selectAllChildren(code); copy.textContent = 'Selected'; }
    setTimeout(() => { copy.textContent = 'Copy'; }, 1600);
  }}, 'Copy');
  return el('div', {class: 'command'}, code, copy);
}

// A table whose columns sort by a button in their head; absent values stay last either way.
// column: {title, hint, text?, best?, value(row), show(row)}; values are held against those of rows with the same groupOf.
function sortableTable(caption, columns, rows, groupOf = () => '') {
  const body = el('tbody');
  const heads = columns.map((column, c) => el('th', {scope: 'col', class: column.text ? 'text' : null, title: column.hint},
    el('button', {type: 'button', onclick: () => sort(c)}, column.title)));
  const lines = rows.map(row => ({row, line: el('tr', {}, columns.map((column, c) => cell(column, row, c)))}));
  function cell(column, row, c) {
    const shown = column.show(row);
    if (c === 0) return el('th', {scope: 'row'}, shown);
    const node = el('td', {class: column.text ? 'text' : null}, shown);
    const value = column.value(row);
    if (column.best && typeof value === 'number') {
      const range = rows.filter(other => groupOf(other) === groupOf(row)).map(column.value).filter(other => typeof other === 'number');
      const most = Math.max(...range);
      node.classList.add('measured');
      node.style.setProperty('--share', most > 0 ? value / most : 0);
      if (range.length > 1 && value === Math.min(...range) && value < most) node.classList.add('best');
    }
    return node;
  }
  function sort(c) {
    const descending = heads[c].getAttribute('aria-sort') === 'ascending';
    heads.forEach(head => head.removeAttribute('aria-sort'));
    heads[c].setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    const value = ({row}) => columns[c].value(row);
    const none = item => value(item) === null || value(item) === undefined;
    lines.sort((a, b) => {
      if (none(a) || none(b)) return none(a) - none(b);
      const order = typeof value(a) === 'string' ? value(a).localeCompare(value(b)) : value(a) - value(b);
      return descending ? -order : order;
    });
    body.append(...lines.map(item => item.line));
  }
  body.append(...lines.map(item => item.line));
  return el('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption},
    el('table', {'aria-label': caption}, el('thead', {}, el('tr', {}, heads)), body));
}

// Flicker needs a camera path, and 'against' a recipe to be held against; without them they have no column.
const asked = {flicker: data.runs.some(run => run.path), path_rmse: data.runs.some(run => run.path), against: data.against, against_mean: data.against};
const metrics = data.metrics.filter(metric => !(metric.name in asked) || asked[metric.name]);
const metricColumns = of => metrics.map(metric => ({
  title: metric.name, hint: metric.sentence, best: !['edge', 'against_mean'].includes(metric.name),
  value: row => of(row)[metric.name], show: row => figure(of(row)[metric.name]),
}));
// Errors where the light is weak count for little to the eye: the same figures with each sample weighed by its irradiance.
const weightedColumns = of => ['rmse', 'leak', 'acne'].map(name => ({
  title: `weighted ${name}`, hint: `${name}, each sample weighed by the light that falls on it where nothing is in the way`, best: true,
  value: row => (of(row) || {})[name], show: row => figure((of(row) || {})[name]),
}));

function errorTable(scene, runs) {
  const columns = [
    {title: 'recipe', text: true, value: fullName, show: run => [nameOf(run), run.status === 'ok' ? [' ', shortOf(run)] : [' ', statusOf(run)]].flat(2).filter(Boolean)},
    ...metricColumns(run => run.error),
    ...weightedColumns(run => run.weighted),
    {title: 'shadow ms', hint: 'Median time of all passes that exist only because of shadows', best: true,
      value: run => run.time_ms.shadow.median, show: run => milliseconds(run.time_ms.shadow.median)},
    {title: 'frame ms', hint: 'Median time of the whole frame', best: true,
      value: run => run.time_ms.frame.median, show: run => milliseconds(run.time_ms.frame.median)},
    {title: 'memory', hint: 'Bytes of everything that exists only because of shadows', best: true,
      value: run => run.status === 'ok' ? run.memory.bytes : null, show: run => run.status === 'ok' ? bytes(run.memory.bytes) : absent},
  ];
  return sortableTable(`Errors and costs in ${scene.name}`, columns, runs);
}

function lightTable(scene, runs) {
  const rows = scene.lights.flatMap((_, l) => runs.filter(run => run.lights[l]).map(run => ({run, light: run.lights[l], l})));
  const columns = [
    {title: 'light', text: true, value: row => row.light.name, show: row => row.light.name},
    {title: 'recipe', text: true, value: row => fullName(row.run), show: row => nameOf(row.run)},
    {title: 'status', text: true, value: row => row.light.status, show: row => statusOf(row.light)},
    {title: 'samples', hint: 'View samples that count for this light', value: row => row.light.samples,
      show: row => row.light.samples.toLocaleString('en')},
    {title: 'lit', hint: 'Of them, those that the truth finds lit: what acne is the mean of', value: row => row.light.found.lit,
      show: row => row.light.found.lit.toLocaleString('en')},
    {title: 'dark', hint: 'Of them, those that the truth finds dark: what leak is the mean of', value: row => row.light.found.dark,
      show: row => row.light.found.dark.toLocaleString('en')},
    ...metricColumns(row => row.light.error).filter(column => !['luma_rms', 'flip'].includes(column.title)),
    ...weightedColumns(row => row.light.weighted),
    {title: 'error map', text: true, value: row => row.light.error.rmse, show: row => row.light.reason
      ? el('div', {class: 'reason'}, row.light.reason)
      : row.light.error_map ? el('a', {href: row.light.error_map}, picture(row.light.error_map, `Signed error of ${fullName(row.run)} for light ${row.light.name}`, scene, 'thumb')) : absent},
  ];
  return sortableTable(`Errors by light in ${scene.name}`, columns, rows, row => row.l);
}

function picture(source, description, scene, style) {
  return el('img', {src: source, alt: description, loading: 'lazy', width: scene.size[0], height: scene.size[1], class: style});
}
const describeRun = (scene, run) => `${scene.name} with shadows by ${fullName(run)}`;
const describeError = run => `Signed error of visibility of ${fullName(run)}, rmse ${figure(run.error.rmse)}`;

const describeInside = (run, item) => `${item.name} of ${fullName(run)} for light ${item.light}. ${item.legend}`;

function legend() {
  const ticks = [-1, -0.25, -0.05, 0, 0.05, 0.25, 1];
  const at = value => 50 + 50 * Math.sign(value) * Math.sqrt(Math.abs(value));
  return el('div', {class: 'legend', role: 'img', 'aria-label': 'Scale of the error maps: blue where the technique is darker than the truth, amber where it is lighter, near black where equal; hatched grey is not counted'},
    el('img', {src: 'pictures/error-scale.png', alt: ''}),
    el('div', {class: 'ticks num'}, ticks.map(value => el('span', {style: `left:${at(value)}%`}, value < 0 ? `−${-value}` : `${value}`))),
    el('div', {class: 'ends'}, el('span', {}, 'too dark: acne'), el('span', {}, 'T − R, hatched: not counted'), el('span', {}, 'too light: leaks')));
}

// Two pictures on one stage: slide between them, or flip from one to the other.
function comparer(scene, runs) {
  const shown = runs.filter(run => run.picture);
  if (!scene.reference.picture || !shown.length) return {node: el('span'), choose() {}};
  const choices = [{title: 'traced reference', picture: scene.reference.picture, text: `${scene.name}, traced reference`},
    ...shown.map(run => ({title: fullName(run), picture: run.picture, text: describeRun(scene, run)})),
    ...shown.filter(run => run.error_map).map(run => ({title: 'error of ' + fullName(run), picture: run.error_map, text: describeError(run)})),
    ...shown.flatMap(run => run.inside.filter(item => item.of_view && item.picture).map(item => (
      {title: `${item.name} of ${fullName(run)}`, picture: item.picture, text: describeInside(run, item)})))];
  const below = el('img', {width: scene.size[0], height: scene.size[1]});
  const above = el('img', {width: scene.size[0], height: scene.size[1], class: 'top'});
  const leftTag = el('span', {class: 'tag left'}), rightTag = el('span', {class: 'tag right'});
  const stage = el('figure', {class: 'stage'}, below, above, el('span', {class: 'seam'}), leftTag, rightTag);
  const slider = el('input', {type: 'range', class: 'slider', min: 0, max: 100, step: .5, value: 50, 'aria-label': 'Where the left picture ends'});
  const options = () => choices.map((choice, index) => el('option', {value: index}, choice.title));
  const left = el('select', {}, options()), right = el('select', {}, options());
  right.value = 1;
  const slide = el('button', {type: 'button', 'aria-pressed': 'true'}, 'Slide');
  const flip = el('button', {type: 'button', 'aria-pressed': 'false'}, 'Flip');
  const hint = el('small', {'aria-live': 'polite'});
  function update() {
    const [a, b] = [choices[left.value], choices[right.value]];
    below.src = a.picture; below.alt = a.text;
    above.src = b.picture; above.alt = b.text;
    const flipping = stage.classList.contains('flip'), on = stage.classList.contains('on');
    leftTag.textContent = flipping && on ? b.title : a.title;
    rightTag.textContent = b.title;
    rightTag.hidden = flipping;
    hint.textContent = flipping ? 'Point at the picture, or press Flip, to see the other one.' : 'Drag across the picture, or use the slider.';
  }
  function show(on) { stage.classList.toggle('on', on); update(); }
  function split(percent) {
    stage.style.setProperty('--split', percent + '%');
    slider.value = percent;
  }
  function follow(event) {
    if (stage.classList.contains('flip')) return;
    const box = stage.getBoundingClientRect();
    split(Math.min(100, Math.max(0, 100 * (event.clientX - box.left) / box.width)));
  }
  stage.addEventListener('pointerdown', event => { stage.setPointerCapture(event.pointerId); follow(event); event.preventDefault(); });
  stage.addEventListener('pointermove', event => { if (event.buttons) follow(event); });
  stage.addEventListener('pointerenter', () => { if (stage.classList.contains('flip')) show(true); });
  stage.addEventListener('pointerleave', () => { if (stage.classList.contains('flip')) show(false); });
  slider.addEventListener('input', () => split(slider.value));
  left.addEventListener('change', update);
  right.addEventListener('change', update);
  slide.addEventListener('click', () => {
    stage.classList.remove('flip', 'on');
    slide.setAttribute('aria-pressed', 'true'); flip.setAttribute('aria-pressed', 'false'); update();
  });
  flip.addEventListener('click', () => {
    const flipping = stage.classList.contains('flip');
    stage.classList.add('flip');
    slide.setAttribute('aria-pressed', 'false'); flip.setAttribute('aria-pressed', 'true');
    show(flipping && !stage.classList.contains('on'));
  });
  split(50);
  update();
  const bar = el('div', {class: 'toolbar'}, el('label', {}, 'Left', left), el('label', {}, 'Right', right),
    el('span', {class: 'set', role: 'group', 'aria-label': 'How to compare'}, slide, flip), hint);
  return {node: el('div', {}, bar, stage, slider), choose(run) {
    right.value = 1 + shown.indexOf(run);
    update();
    stage.scrollIntoView({block: 'center'});
  }};
}

function gallery(scene, runs, choose) {
  const cards = [];
  if (scene.reference.picture) {
    cards.push(el('figure', {class: 'card'}, el('div', {class: 'pair'}, picture(scene.reference.picture, `${scene.name}, traced reference`, scene)),
      el('figcaption', {}, el('strong', {}, 'traced reference'), el('small', {class: 'num'}, `${scene.reference.samples} samples a light`))));
  }
  for (const run of runs) {
    const pair = run.picture
      ? el('div', {class: 'pair'},
          el('button', {class: 'pick', type: 'button', 'aria-label': `Compare ${fullName(run)} with the reference`, onclick: () => choose(run)}, picture(run.picture, describeRun(scene, run), scene)),
          run.error_map ? picture(run.error_map, describeError(run), scene) : null)
      : el('div', {class: 'pair'}, el('div', {class: 'empty'}, run.reason || 'No picture.'));
    cards.push(el('figure', {class: 'card'}, pair, el('figcaption', {}, el('strong', {}, nameOf(run)),
      run.status === 'ok' ? el('small', {class: 'num'}, `rmse ${figure(run.error.rmse)}`) : statusOf(run))));
  }
  return el('div', {class: 'gallery'}, cards);
}

// What the recipes hide: one row of small pictures a run, each a link to the picture itself.
function insides(runs) {
  return el('div', {}, runs.filter(run => run.inside.some(item => item.picture)).map(run => el('section', {class: 'inside'},
    el('h4', {}, nameOf(run), el('small', {}, ` light ${run.inside[0].light}`)),
    el('div', {class: 'strip'}, run.inside.filter(item => item.picture).map(item => el('figure', {class: 'card'},
      el('a', {href: item.picture}, el('img', {src: item.picture, alt: describeInside(run, item), loading: 'lazy'})),
      el('figcaption', {}, el('strong', {}, item.name), el('small', {}, item.legend))))))));
}

// Flicker over the steps of a camera path: one line a run, all on one scale.
function pathChart(runs) {
  const space = 'http://www.w3.org/2000/svg', width = 640, height = 150;
  const most = Math.max(...runs.flatMap(run => run.path_flicker.filter(value => value !== null)), 1e-9);
  const part = (tag, attributes, text) => {
    const node = document.createElementNS(space, tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    if (text) node.textContent = text;
    return node;
  };
  const svg = part('svg', {viewBox: `0 0 ${width} ${height}`, class: 'path-chart', role: 'img',
    'aria-label': `Flicker of each step, at most ${figure(most)}: ` + runs.map(run => `${fullName(run)} ${figure(run.error.flicker)}`).join(', ')});
  svg.append(part('path', {d: `M0 ${height - .5}H${width}M0 .5H${width}`, class: 'rule'}));
  runs.forEach((run, r) => {
    const steps = run.path_flicker, at = k => steps.length > 1 ? k * width / (steps.length - 1) : 0;
    let d = '', pen = 'M';
    steps.forEach((value, k) => {
      if (value === null) { pen = 'M'; return; }
      d += `${pen}${at(k).toFixed(1)} ${((height - 2) * (1 - value / most) + 1).toFixed(1)}`;
      pen = 'L';
    });
    const line = part('path', {d, class: `line hue-${r % 6}`});
    line.append(part('title', {}, `${fullName(run)}: ${figure(run.error.flicker)}`));
    svg.append(line);
  });
  return el('div', {}, svg,
    el('div', {class: 'key num'}, el('span', {}, `Steps of the path '${runs[0].path}', one a frame; the scale ends at ${figure(most)}.`),
      runs.map((run, r) => el('span', {}, el('i', {class: `hue-${r % 6}`}), `${fullName(run)} ${figure(run.error.flicker)}`))));
}

function timeBars(runs) {
  const most = Math.max(...runs.map(run => run.time_ms.passes.reduce((sum, pass) => sum + pass.median, 0)), 1e-9);
  const rows = runs.flatMap(run => {
    const description = run.time_ms.passes.map(pass => `${pass.name} ${milliseconds(pass.median)} ms`).join(', ');
    return [el('span', {class: 'name'}, nameOf(run)),
      el('div', {class: 'stack', role: 'img', 'aria-label': `Passes of ${fullName(run)}: ${description}`}, run.time_ms.passes.map(pass =>
        el('i', {class: `${pass.group}-pass`, style: `width:${100 * pass.median / most}%`, title: `${pass.name}: ${milliseconds(pass.median)} ms`}))),
      el('span', {class: 'num'}, `${milliseconds(run.time_ms.shadow.median)} ms`)];
  });
  const key = ['scene', 'shadow', 'shading'].map(group => el('span', {}, el('i', {class: `${group}-pass`}), group));
  return el('div', {}, el('div', {class: 'costs'}, rows),
    el('div', {class: 'key'}, key, el('span', {}, 'The figure is the shadow passes\u2019 median; the bar is the whole frame, pass by pass.')));
}

function byteBars(runs) {
  const most = Math.max(...runs.map(run => run.memory.bytes), 1);
  return el('div', {class: 'costs'}, runs.flatMap(run => [
    el('span', {class: 'name'}, nameOf(run)),
    el('div', {class: 'stack', role: 'img', 'aria-label': `Memory of ${fullName(run)}: ${run.memory.resources.map(item => `${item.name} ${bytes(item.bytes)}`).join(', ') || 'none'}`},
      run.memory.resources.map(item => el('i', {class: 'shadow-pass', style: `width:${100 * item.bytes / most}%`, title: `${item.name}: ${bytes(item.bytes)}`}))),
    el('span', {class: 'num'}, bytes(run.memory.bytes))]));
}

function plainTable(caption, heads, rows) {
  return el('table', {'aria-label': caption}, el('thead', {}, el('tr', {}, heads.map(head => el('th', {scope: 'col'}, head)))),
    el('tbody', {}, rows.map(row => el('tr', {}, row.map((item, c) => c ? el('td', {}, item) : el('th', {scope: 'row'}, item))))));
}

function runDetails(run) {
  return el('details', {}, el('summary', {}, el('strong', {}, nameOf(run)), ' ', el('span', {class: 'soft'}, run.title || '')),
    run.paragraph ? el('p', {}, run.paragraph, run.citation ? ` [${run.citation}]` : '') : null,
    ...run.remarks.map(remark => el('p', {}, el('strong', {}, 'Note: '), `${remark}.`)),
    run.reason ? el('p', {}, statusOf(run), ' ', run.reason) : null,
    run.status === 'ok' ? groupedReasons(run.lights.filter(light => light.reason)).map(line => el('p', {}, el('strong', {}, 'Left out: '), line)) : [],
    command(run.command),
    el('div', {class: 'columns'},
      run.parameters.length ? plainTable('Parameters', ['parameter', 'value'], run.parameters.map(item => [item.name, item.value])) : null,
      run.time_ms.passes.length ? plainTable('Passes', ['pass', 'ms'], run.time_ms.passes.map(pass => [pass.name, milliseconds(pass.median)])) : null,
      run.memory.resources.length ? plainTable('Resources', ['resource', 'memory'], run.memory.resources.map(item => [item.name, bytes(item.bytes)])) : null));
}

const anchor = index => `scene-${index + 1}`;
function sceneSection(scene, index) {
  const runs = data.runs.filter(run => run.scene === scene.scene);
  const measured = runs.filter(run => run.status === 'ok');
  const most = 8, more = scene.lights.length - most;
  const lights = scene.lights.slice(0, most).map(light => `${light.name} (${light.kind}, ${light.size})`).join(', ') + (more > 0 ? ` and ${more} more` : '');
  const stage = comparer(scene, runs);
  const facts = [`View ${scene.view || 'unknown'}`, `${scene.size[0]} × ${scene.size[1]} pixels`, scene.triangles ? `${scene.triangles.toLocaleString('en')} triangles` : '']
    .filter(Boolean).join(', ');
  return el('section', {class: 'scene', id: anchor(index), 'aria-labelledby': anchor(index) + '-title'},
    el('h2', {id: anchor(index) + '-title'}, scene.name),
    el('p', {class: 'lede'}, facts + '.', lights ? ` Lights: ${lights}.` : ''),
    scene.notes.length ? el('ul', {class: 'notes'}, scene.notes.map(note => el('li', {}, note))) : null,
    stage.node,
    el('h3', {}, 'Errors and costs'), errorTable(scene, runs),
    el('h3', {}, 'Pictures and signed errors'), legend(), gallery(scene, runs, stage.choose),
    measured.some(run => run.path_flicker.length) ? [el('h3', {}, 'Flicker along a path'), pathChart(measured.filter(run => run.path_flicker.length))] : null,
    runs.some(run => run.inside.length) ? [el('h3', {}, 'What the maps hide'), insides(runs)] : null,
    measured.length ? [el('h3', {}, 'Time'), timeBars(measured), el('h3', {}, 'Memory for shadows'), byteBars(measured)] : null,
    el('h3', {}, 'Details'),
    runs.some(run => run.lights.length)
      ? el('details', {open: scene.lights.length > 1 && scene.lights.length <= 4}, el('summary', {}, el('strong', {}, 'Errors by light')), lightTable(scene, runs)) : null,
    runs.map(runDetails));
}

// With several scenes: one metric, every recipe, every scene.
function overview() {
  if (data.scenes.length < 2) return '';
  const names = [...new Set(data.runs.map(fullName))];
  const find = (name, scene) => data.runs.find(run => run.scene === scene.scene && fullName(run) === name);
  const choice = el('select', {}, metrics.map(metric => el('option', {value: metric.name, title: metric.sentence}, metric.name)),
    el('option', {value: 'time'}, 'shadow ms'));
  const place = el('div');
  function value(name, scene) {
    const run = find(name, scene);
    return !run ? null : choice.value === 'time' ? run.time_ms.shadow.median : run.error[choice.value];
  }
  function draw() {
    const show = choice.value === 'time' ? milliseconds : figure;
    place.replaceChildren(sortableTable(`${choice.value} by recipe and scene`, [
      {title: 'scene', text: true, value: scene => scene.name, show: scene => el('a', {href: '#' + anchor(data.scenes.indexOf(scene))}, scene.name)},
      ...names.map(name => ({title: name, value: scene => value(name, scene), show: scene => {
        const run = find(name, scene);
        return run && run.status !== 'ok' ? statusOf(run) : show(value(name, scene));
      }})),
    ], data.scenes));
  }
  choice.addEventListener('change', draw);
  draw();
  return el('section', {class: 'overview', 'aria-labelledby': 'overview-title'}, el('h2', {id: 'overview-title'}, 'All scenes'),
    el('div', {class: 'toolbar'}, el('label', {}, 'Figure', choice)), place);
}

// Theme: the system's, unless the button says otherwise.
const root = document.documentElement, dark = matchMedia('(prefers-color-scheme: dark)');
let chosen = null;
try { chosen = localStorage.getItem('gnomon-theme'); } catch { /* storage is off for some file: pages */ }
const themeAsked = new URLSearchParams(location.search).get('theme');
if (themeAsked === 'dark' || themeAsked === 'light') chosen = themeAsked;
const toggle = el('button', {type: 'button', onclick: () => {
  chosen = root.dataset.theme === 'dark' ? 'light' : 'dark';
  try { localStorage.setItem('gnomon-theme', chosen); } catch { /* not kept */ }
  paint();
}});
function paint() {
  root.dataset.theme = chosen || (dark.matches ? 'dark' : 'light');
  toggle.textContent = root.dataset.theme === 'dark' ? 'Light' : 'Dark';
  toggle.setAttribute('aria-label', `Switch to the ${toggle.textContent.toLowerCase()} theme`);
}
dark.addEventListener('change', paint);
paint();

function sundial() {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 32 32');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', 'M3 25h26M5 25a11 11 0 0 1 22 0M16 25L16 7M16 25L26 18');
  path.setAttribute('fill', 'none');
  path.setAttribute('stroke', 'currentColor');
  path.setAttribute('stroke-width', '2');
  path.setAttribute('stroke-linecap', 'round');
  svg.append(path);
  return svg;
}

function fact(title, text) { return el('div', {}, el('dt', {}, title), el('dd', {class: 'num'}, text)); }
const error = data.reference.standard_error;
document.getElementById('masthead').append(
  el('div', {class: 'brand'}, sundial(), 'Gnomon', el('span', {class: 'grow'}), toggle),
  el('h1', {}, 'Shadows compared with ray-traced truth'),
  el('dl', {class: 'facts'},
    fact('Device', `${data.device.name} (${data.device.kind === 'cpu' ? 'software' : 'GPU'})`),
    fact('Driver', data.device.driver),
    fact('Reference', `${data.reference.samples} samples a light, ${data.reference.seconds.toFixed(1)} s`),
    fact('Its standard error', error === null ? absent : `${error.toExponential(1)} of the mean V`),
    data.against ? fact('Held against', data.against) : '',
    fact('Timing', `median of ${data.repeat} frames after a warm-up`)),
  command(data.command));
if (data.scenes.length > 1) {
  document.getElementById('masthead').append(el('nav', {class: 'scenes', 'aria-label': 'Scenes'},
    data.scenes.map((scene, index) => el('a', {href: '#' + anchor(index)}, scene.name))));
}
document.getElementById('scenes').append(overview(), ...data.scenes.map(sceneSection));
document.getElementById('colophon').append(
  el('p', {}, 'T is the technique\u2019s visibility, R the reference\u2019s, over the view samples that face the light and lie in its range. A figure without samples is \u2013. The smallest value of a column is green; the bar below a value is its share of the largest. Weighted figures weigh each sample by the light that falls on it where nothing is in the way.'),
  el('dl', {}, data.metrics.flatMap(metric => [el('dt', {}, metric.name), el('dd', {}, metric.sentence)])),
  el('p', {}, `Gnomon ${data.version}, schema ${data.schema}.`));
})();
