// SPDX-License-Identifier: MIT
'use strict';
(() => {
const root = document.getElementById('admin'), key = new URLSearchParams(location.search).get('key') || '';
document.documentElement.dataset.theme = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
let chosen = null;

const heads = names => el('thead', {}, el('tr', {}, names.map(name => el('th', {scope: 'col'}, name))));
const row = cells => el('tr', {}, cells.map((cell, i) => el('td', {class: i ? 'num' : 'text'}, String(cell))));

// [Kre17] fig. 4.5: trial against radius, a chart a quest of the round at hand.
function questCharts(person) {
  const round = person.rounds[person.round];
  return el('section', {}, el('h3', {}, `Participant ${person.participant}, round ${person.round + 1}: ${round.pattern}, contrast ${100 * round.contrast} %`),
    el('div', {class: 'charts'}, round.quests.map(quest => chart({
      title: `${quest.artifact} pixels: ${quest.converged ? 'converged' : 'not converged'}, radius ${plain(quest.radius)}, deviation ${plain(quest.deviation)} decades`,
      xLabel: 'trial', yLabel: 'radius, pixels', yZero: true, lines: [{y: quest.radius, name: 'threshold'}],
      series: [{name: '', points: quest.radii.map((radius, i) => ({x: i + 1, y: radius}))}]}))));
}

function ranking(one) {
  const marks = name => one.subsets.map((subset, i) => subset.includes(name) ? i + 1 : '').filter(Boolean).join(' ');
  return el('section', {}, el('h3', {}, `${one.name}: ${one.answers} answers`),
    el('div', {class: 'scroll'}, el('table', {}, heads(['technique', 'mean rank (1 = best)', 'on the screen (9 = best)', 'subsets']),
      el('tbody', {}, one.order.map(placed => row([placed.name, plain(placed.mean_rank), plain(10 - placed.mean_rank), marks(placed.name)]))))),
    chart({title: 'Mean ranks', xLabel: '', yLabel: '9 = best', categories: one.order.map(placed => placed.name), series: [{name: '', dots: true,
      points: one.answers ? one.order.map((placed, i) => ({x: i, y: 10 - placed.mean_rank, label: `${placed.name}: ${plain(10 - placed.mean_rank)}`})) : []}]}));
}

function fits(results) {
  return el('section', {}, el('h3', {}, 'radius = c x artifact'), el('div', {class: 'scroll'}, el('table', {},
    heads(['pattern', 'contrast', 'c', 'from', 'to', 'thresholds']),
    el('tbody', {}, results.conditions.map(one => row([one.pattern, one.contrast, plain(one.c), plain(one.low), plain(one.high), one.thresholds]))))),
    el('div', {class: 'charts'}, chart({title: 'Radius over artifact', xLabel: 'artifact, pixels', yLabel: 'radius, pixels', yZero: true,
      series: results.conditions.map(one => ({name: `${one.pattern}, ${100 * one.contrast} %`,
        points: one.sizes.filter(size => size.mean_radius !== null).map(size => ({x: size.artifact, y: size.mean_radius}))}))})));
}

function paint(data) {
  const people = data.people, open = people.filter(person => !person.done);
  const watched = people.find(person => person.participant === chosen) || open[open.length - 1] || people[people.length - 1];
  const list = el('div', {class: 'scroll'}, el('table', {}, heads(['participant', 'answers', 'state', '']), el('tbody', {}, people.map(person =>
    el('tr', {}, el('td', {class: 'text'}, String(person.participant)), el('td', {class: 'num'}, String(person.answers)), el('td', {}, person.done ? 'done' : 'under way'),
      el('td', {}, data.kind === 'threshold' ? el('button', {type: 'button', onclick: () => { chosen = person.participant; paint(data); }}, 'watch') : ''))))));
  root.replaceChildren(...[el('h1', {}, `${people.length} participant${people.length === 1 ? '' : 's'}, ${people.length - open.length} done`),
    el('p', {}, el('a', {href: `/api/admin/export?key=${key}`, download: 'answers.csv'}, 'All answers as CSV')),
    data.kind === 'threshold' && watched ? questCharts(watched) : null, list,
    ...(data.kind === 'threshold' ? [fits(data.results)] : data.results.rankings.map(ranking))].filter(Boolean));
}

async function refresh() {
  try {
    const reply = await fetch(`/api/admin?key=${key}`);
    const data = await reply.json();
    if (!reply.ok) throw new Error(data.error);
    paint(data);
  } catch (error) { root.replaceChildren(el('p', {class: 'wrong'}, error.message)); }
  setTimeout(refresh, 2000);
}
refresh();
})();
