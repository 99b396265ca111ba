// SPDX-License-Identifier: MIT
'use strict';
(() => {
const data = JSON.parse(document.getElementById('data').textContent);
document.documentElement.dataset.theme = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';

const labels = {shadow_ms: 'shadow, ms', frame_ms: 'frame, ms', bytes: 'memory, bytes'};
const labelOf = name => labels[name] || name;
const counts = runs => runs.reduce((all, run) => ({...all, [run.status]: (all[run.status] || 0) + 1}), {});
const gridNamed = name => data.grids.find(grid => grid.name === name) || data.grids[0];
const figuresOf = grid => [...new Set(grid.runs.flatMap(run => Object.keys(run.figures)))];
const axisOf = (grid, name) => grid.axes.findIndex(axis => axis.name === name);

// Where a run lies along x or y: at a value of an axis, or at a figure of its own.
function coordinate(grid, run, name) {
  const axis = axisOf(grid, name);
  if (axis < 0) return run.figures[name];
  const values = grid.axes[axis].values;
  return numeric(grid, name) ? Number(run.at[axis]) : values.indexOf(run.at[axis]);
}
function numeric(grid, name) {
  const axis = axisOf(grid, name);
  return axis < 0 || grid.axes[axis].values.every(value => value !== '' && Number.isFinite(Number(value)));
}

// Runs that no other beats in both figures; smaller is better.
function front(points) {
  const best = [];
  let least = Infinity;
  for (const point of [...points].sort((a, b) => a.x - b.x || a.y - b.y))
    if (point.y < least) { best.push(point); least = point.y; }
  return best;
}

function draw(plot) {
  const grid = gridNamed(plot.grid), by = axisOf(grid, plot.by), free = axisOf(grid, plot.x) < 0;
  const fixed = Object.entries(plot.where).map(([name, value]) => [axisOf(grid, name), value]);
  const runs = grid.runs.filter(run => fixed.every(([axis, value]) => axis < 0 || run.at[axis] === value));
  const names = by < 0 ? [''] : grid.axes[by].values;
  const series = names.map(name => ({
    name, dots: free,
    points: runs.filter(run => by < 0 || run.at[by] === name).map(run => ({
      x: coordinate(grid, run, plot.x), y: coordinate(grid, run, plot.y),
      label: `${run.scene}, ${run.recipe}: ${plain(coordinate(grid, run, plot.x))}, ${plain(coordinate(grid, run, plot.y))}`}))
      .filter(point => Number.isFinite(point.x) && Number.isFinite(point.y)),
  }));
  // Several runs at one place of a curve, where an axis was not fixed, become their mean.
  if (!free) for (const one of series) {
    const at = new Map();
    for (const point of one.points) at.set(point.x, [...(at.get(point.x) || []), point]);
    one.points = [...at].map(([x, points]) => points.length === 1 ? points[0]
      : {x, y: points.reduce((sum, p) => sum + p.y, 0) / points.length, label: `${one.name}: mean of ${points.length} runs`});
  }
  const shown = series.filter(one => one.points.length);
  if (free) shown.push({name: 'the best (Pareto front)', points: front(shown.flatMap(one => one.points))});
  const values = shown.flatMap(one => one.points);
  const wide = (name, key) => values.every(p => p[key] > 0) && Math.max(...values.map(p => p[key])) > 4 * Math.min(...values.map(p => p[key]));
  const where = Object.entries(plot.where).map(([name, value]) => `${name} ${value}`).join(', ');
  return chart({
    title: (plot.title || `${labelOf(plot.y)} over ${labelOf(plot.x)}`) + (where ? ` (${where})` : ''), xLabel: labelOf(plot.x), yLabel: labelOf(plot.y),
    categories: numeric(grid, plot.x) ? null : grid.axes[axisOf(grid, plot.x)].values,
    xLog: wide(plot.x, 'x'), yLog: wide(plot.y, 'y'), series: shown});
}

function select(label, names, value, change) {
  const box = el('select', {'aria-label': label, onchange: () => change(box.value)},
                 names.map(name => el('option', {value: name, selected: name === value}, name)));
  return el('label', {}, label, box);
}

// Any figure over any axis, or over another figure.
function explorer() {
  const first = data.plots[0] || {};
  const state = {grid: gridNamed(first.grid).name, x: first.x, y: first.y, by: first.by, where: {...first.where}};
  const bar = el('div', {class: 'toolbar'}), place = el('div', {class: 'charts'});
  function paint() {
    const grid = gridNamed(state.grid), axes = grid.axes.map(axis => axis.name), figures = figuresOf(grid);
    if (![...axes, ...figures].includes(state.x)) state.x = axes[axes.length - 1] || figures[0];
    if (!figures.includes(state.y)) state.y = figures[0];
    if (!axes.includes(state.by)) state.by = '';
    for (const axis of Object.keys(state.where)) if (!axes.includes(axis)) delete state.where[axis];
    const set = (key, value) => { state[key] = value; paint(); };
    bar.replaceChildren(
      data.grids.length > 1 ? select('grid', data.grids.map(g => g.name), state.grid, value => set('grid', value)) : '',
      select('over', [...axes, ...figures], state.x, value => set('x', value)),
      select('figure', figures, state.y, value => set('y', value)),
      select('a curve each', ['', ...axes], state.by, value => set('by', value)),
      ...grid.axes.filter(axis => axis.name !== state.x && axis.name !== state.by).map(axis =>
        select(axis.name, ['', ...axis.values], state.where[axis.name] || '', value => {
          if (value) state.where[axis.name] = value; else delete state.where[axis.name];
          paint();
        })));
    place.replaceChildren(figures.length ? draw(state) : el('p', {class: 'soft'}, 'Nothing is measured yet.'));
  }
  paint();
  return el('section', {class: 'overview'}, el('h2', {}, 'Any figure over anything'), bar, place);
}

function limits() {
  if (!data.limits) return null;
  const l = data.limits, cell = value => el('td', {class: 'num'}, value === null ? 'not one' : plain(value));
  return el('section', {class: 'overview'}, el('h2', {}, 'How much fits into a frame'),
    el('p', {}, `Limit 1: the most ${l.objects} at any ${l.target}, and the largest that still carries them. Limit 2: the most at the largest ${l.target} that was drawn. Counts between two tested ones are interpolated.`),
    el('div', {class: 'scroll'}, el('table', {'aria-label': 'Limits'},
      el('thead', {}, el('tr', {}, ['budget, ms', ...l.axes, 'limit 1', `at ${l.target}`, 'limit 2', `at ${l.target}`, 'runs'].map(name => el('th', {scope: 'col'}, name)))),
      el('tbody', {}, l.rows.map(row => el('tr', {}, el('td', {class: 'num'}, plain(row.budget_ms)), row.at.map(value => el('td', {class: 'text'}, value)),
        cell(row.most), row.most_at === null ? el('td', {}, '–') : cell(row.most_at), cell(row.at_largest), cell(row.largest), cell(row.samples)))))));
}

// What was not measured, by its reason.
function troubles() {
  const groups = new Map();
  for (const run of data.grids.flatMap(grid => grid.runs))
    if (['absent', 'refused', 'failed', 'empty'].includes(run.status)) {
      const key = `${run.status}: ${run.recipe}: ${run.reason}`;
      groups.set(key, (groups.get(key) || 0) + 1);
    }
  return groups.size ? el('section', {class: 'overview'}, el('h2', {}, 'Without figures'),
    el('ul', {class: 'notes'}, [...groups].map(([text, count]) => el('li', {}, text + (count > 1 ? ` (${count} runs)` : ''))))) : null;
}

function table(grid) {
  const figures = figuresOf(grid);
  return el('details', {}, el('summary', {}, el('strong', {}, `${grid.name}: ${grid.runs.length} runs`)),
    el('div', {class: 'scroll'}, el('table', {'aria-label': `Runs of ${grid.name}`},
      el('thead', {}, el('tr', {}, [...grid.axes.map(axis => axis.name), 'status', ...figures].map(name => el('th', {scope: 'col'}, name)))),
      el('tbody', {}, grid.runs.slice(0, 2000).map(run => el('tr', {}, run.at.map(value => el('td', {class: 'text'}, value)),
        el('td', {class: 'text'}, el('span', {class: 'status ' + run.status, title: run.reason}, run.status)),
        figures.map(name => el('td', {class: 'num'}, plain(run.figures[name])))))))),
    grid.runs.length > 2000 ? el('p', {class: 'soft'}, 'The first 2,000; all of them are in runs.csv.') : null);
}

const all = data.grids.flatMap(grid => grid.runs);
document.title = `Gnomon: ${data.title}`;
document.getElementById('masthead').append(el('h1', {}, data.title), el('p', {}, data.paragraph), el('dl', {class: 'facts'},
  [['runs', Object.entries(counts(all)).map(([status, count]) => `${count} ${status}`).join(', ')],
   ['device', data.devices.join('; ') || 'none yet'], ['version', data.version + (data.quick ? ', quick version' : '')], ['after', data.citation || '–']]
    .map(([name, value]) => el('div', {}, el('dt', {}, name), el('dd', {class: 'num'}, value)))));
if (data.devices.length > 1) document.getElementById('masthead').append(el('p', {class: 'notice plain'}, 'Runs are of several devices: their times do not compare.'));
document.getElementById('sweep').append(
  el('section', {class: 'overview'}, el('h2', {}, 'Curves'), el('div', {class: 'charts'}, data.plots.map(draw))),
  explorer(), ...[limits(), troubles()].filter(Boolean),
  el('section', {class: 'overview'}, el('h2', {}, 'Every run'), data.grids.map(table)));
document.getElementById('colophon').append(el('p', {}, 'The same figures are in runs.csv. Curves join the means of what is at one place; a dot says which run it is.'));
})();
