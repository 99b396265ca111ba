// SPDX-License-Identifier: MIT
'use strict';
(() => {
const root = document.getElementById('study');
// A page that is loaded again goes on: the token is kept in this tab, and nowhere else.
let token = sessionStorage.getItem('token') || '';
let screen_ = null;

async function ask(path, body) {
  const reply = await fetch(path, body === undefined ? {} : {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
  const json = await reply.json();
  if (!reply.ok) throw Object.assign(new Error(json.error || 'refused'), {status: reply.status});
  return json;
}
const pictureOf = (position, slot) => `/api/picture?token=${token}&position=${position}&slot=${slot}`;
const show = (...children) => { root.replaceChildren(...children.filter(Boolean)); scrollTo(0, 0); };
const wrongLine = () => el('p', {class: 'wrong', role: 'alert'});

async function begin(body) {
  token = (await ask('/api/begin', body)).token;
  sessionStorage.setItem('token', token);
  await next();
}

async function next() {
  const state = await ask(`/api/state?token=${token}`);
  if (state.done) return thanks();
  return state.kind === 'survey' ? surveyPage(state) : trial(state);
}

function thanks() {
  document.body.classList.remove('trial');
  if (document.fullscreenElement) document.exitFullscreen();
  sessionStorage.removeItem('token');
  show(el('h1', {}, 'Thank you'), el('p', {}, 'All of your answers are stored. You may close this page.'));
}

/* ---- the survey: how realistic are these shadows? ---- */

function surveyPage(state) {
  const ranks = new Array(state.pictures).fill(0);
  const wrong = wrongLine(), zoom = el('dialog', {class: 'zoom', onclick: () => zoom.close()});
  const figures = ranks.map((unused, slot) => {
    const buttons = [9, 8, 7, 6, 5, 4, 3, 2, 1].map(value => el('button', {type: 'button', 'aria-pressed': 'false',
      'aria-label': `picture ${slot + 1}: ${value}${value === 9 ? ', the most realistic' : value === 1 ? ', the least realistic' : ''}`, onclick: () => {
        ranks[slot] = value;
        buttons.forEach(button => button.setAttribute('aria-pressed', String(button.textContent === String(value))));
        figure.classList.remove('missing');
      }}, String(value)));
    const image = el('img', {src: pictureOf(state.position, slot), alt: `Picture ${slot + 1} of the scene`, onclick: () => {
      zoom.replaceChildren(el('img', {src: image.src, alt: image.alt}));
      zoom.showModal();
    }});
    const figure = el('figure', {}, image, el('div', {class: 'ranks', role: 'group', 'aria-label': `Rank of picture ${slot + 1}`},
      el('small', {}, 'best'), buttons, el('small', {}, 'worst')));
    return figure;
  });
  const difficulty = [1, 2, 3, 4, 5].map(value => el('label', {}, el('input', {type: 'radio', name: 'difficulty', value}), value === 1 ? 'hard' : value === 5 ? 'easy' : ''));
  const comment = el('textarea', {rows: 2, cols: 60, maxlength: 1000, 'aria-label': 'Anything you want to say (may stay empty)'});
  const go = el('button', {type: 'button', class: 'go', onclick: () => {
    figures.forEach((figure, slot) => figure.classList.toggle('missing', !ranks[slot]));
    const chosen = root.querySelector('input[name=difficulty]:checked');
    if (ranks.includes(0)) { wrong.textContent = 'Every picture needs a rank; those without one are framed.'; return; }
    if (!chosen) { wrong.textContent = 'Please say how hard it was to see differences.'; return; }
    confirmBest({position: state.position, ranks, difficulty: Number(chosen.value), comment: comment.value}, state);
  }}, 'Continue');
  show(el('h1', {}, `Scene ${state.position + 1} of ${state.total}`),
    el('p', {}, 'How realistic are the shadows in each of these pictures of one scene? Give every picture a rank. Pictures between which you see no difference may have the same. Click a picture to enlarge it.'),
    el('p', {class: 'scale'}, el('span', {}, '9 = the most realistic'), el('span', {}, '1 = the least realistic')),
    el('div', {class: 'pictures'}, figures),
    el('h3', {}, 'How hard was it to see differences between them?'), el('p', {class: 'choices'}, difficulty),
    el('h3', {}, 'Anything you want to say (may stay empty)'), comment, wrong, go, zoom);
}

// The same question once more without numbers: ranks the wrong way round cannot agree with it.
function confirmBest(answer, state) {
  const wrong = wrongLine();
  const figures = answer.ranks.map((unused, slot) => el('figure', {}, el('img', {tabindex: 0, role: 'button', 'data-slot': slot, src: pictureOf(state.position, slot),
    alt: `Picture ${slot + 1} is the most realistic`, onclick: () => send(slot), onkeydown: event => { if (event.key === 'Enter') send(slot); }})));
  async function send(slot) {
    if (answer.ranks[slot] !== Math.max(...answer.ranks)) {
      wrong.textContent = `You gave this picture ${answer.ranks[slot]}, and another one ${Math.max(...answer.ranks)}. 9 is the most realistic. Choose another picture, or go back and change your ranks.`;
      return;
    }
    try { await ask('/api/answer', {token, ...answer, best: slot}); await next(); }
    catch (error) { error.status === 409 ? await next() : wrong.textContent = error.message; }
  }
  show(el('h1', {}, 'Which one is the most realistic?'), el('p', {}, 'Click it. If several are equally good, any of them.'), wrong,
    el('div', {class: 'pictures choose'}, figures), el('button', {type: 'button', onclick: () => surveyPage(state)}, 'Back: change my ranks'));
}

/* ---- the threshold study: is the original a line? ---- */

function adjust() {
  let gamma = 2.2, width = 324;
  const patch = el('div', {}), card = el('div', {class: 'card'}), wrong = wrongLine();
  const paintGamma = () => { const v = Math.round(255 * 0.5 ** (1 / gamma)); patch.style.background = `rgb(${v},${v},${v})`; };
  const gammaInput = el('input', {type: 'range', min: 1, max: 4, step: 0.02, value: gamma, id: 'gamma', oninput: event => { gamma = Number(event.target.value); paintGamma(); }});
  const cardInput = el('input', {type: 'range', min: 150, max: 900, step: 1, value: width, id: 'card', oninput: event => { width = Number(event.target.value); card.style.width = `${width}px`; }});
  const distance = el('input', {type: 'number', min: 10, max: 1000, value: 60, id: 'distance'});
  // One line of the pattern is one pixel of the device, whatever the page is zoomed to.
  const lines = el('div', {class: 'lines'}), pixel = 1 / devicePixelRatio;
  lines.style.background = `repeating-linear-gradient(#000 0 ${pixel}px, #fff ${pixel}px ${2 * pixel}px)`;
  paintGamma();
  show(el('h1', {}, 'Your screen'), el('p', {}, 'Please set the page to full size (100 %) and sit as you usually do.'),
    el('h3', {}, '1. Brightness'), el('p', {}, 'Move the slider until both halves look equally bright from where you sit.'),
    el('div', {class: 'gamma'}, lines, patch), el('label', {class: 'field'}, 'brightness ', gammaInput),
    el('h3', {}, '2. Size'), el('p', {}, 'Hold a bank card to the screen, and make the box as wide as the card.'), card, el('label', {class: 'field'}, 'width ', cardInput),
    el('h3', {}, '3. Distance'), el('label', {class: 'field'}, 'From your eyes to the screen, in centimetres ', distance),
    el('h3', {}, 'What you will see'), el('p', {}, 'The edge of a shadow, blurred. Is the original, before it was blurred, a straight line, or does it have steps? Half of the pictures are lines. If you cannot tell, guess. There are four rounds, of about half an hour in all; you may pause whenever you like.'),
    wrong, el('button', {type: 'button', class: 'go', onclick: async () => {
      screen_ = {gamma, pixels_per_cm: width * devicePixelRatio / 8.56, distance_cm: Number(distance.value), device_pixel_ratio: devicePixelRatio};
      try { await document.documentElement.requestFullscreen(); } catch { /* a browser that cannot goes on in its window */ }
      try { await begin({screen: screen_}); } catch (error) { wrong.textContent = error.message; }
    }}, 'Begin, full screen'));
}

function trial(state) {
  document.body.classList.add('trial');
  const wrong = wrongLine();
  const picture = el('img', {src: pictureOf(state.position, 0), alt: 'The edge of a shadow'});
  // A pixel of the picture is a pixel of the screen.
  picture.style.width = picture.style.height = `${state.size / devicePixelRatio}px`;
  let answered = false;
  async function send(line) {
    if (answered || !picture.complete) return;
    answered = true;
    try { await ask('/api/answer', {token, position: state.position, line}); await next(); }
    catch (error) { if (error.status === 409) await next(); else { wrong.textContent = error.message; answered = false; } }
  }
  onkeydown = event => { if (event.key === 'y') send(true); if (event.key === 'n') send(false); };
  show(el('h1', {}, 'Is the original image a line?'), picture,
    el('div', {class: 'answer'}, el('button', {type: 'button', id: 'yes', onclick: () => send(true)}, 'Yes (y)'), el('button', {type: 'button', id: 'no', onclick: () => send(false)}, 'No (n)')),
    wrong, el('small', {}, `round ${state.round} of ${state.rounds}`));
}

async function start() {
  document.documentElement.dataset.theme = 'light';
  if (token) try { return await next(); } catch { sessionStorage.removeItem('token'); token = ''; }
  const kind = (await ask('/api/kind')).kind;
  if (kind === 'threshold') return adjust();
  const wrong = wrongLine();
  show(el('h1', {}, 'How realistic are these shadows?'),
    el('p', {}, 'You will see scenes, each in several pictures that differ in their shadows only, and rank the pictures of each scene. It takes about fifteen minutes. Nothing is stored but your ranks and what you type.'),
    wrong, el('button', {type: 'button', class: 'go', onclick: async () => { try { await begin({}); } catch (error) { wrong.textContent = error.message; } }}, 'Begin'));
}
start().catch(error => show(el('h1', {}, 'The study cannot be reached'), el('p', {}, error.message)));
})();
