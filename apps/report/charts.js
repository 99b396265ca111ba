// SPDX-License-Identifier: MIT
// Curves as SVG, for pages that have some; no library, nothing from a network.
'use strict';

function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

function plain(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (size < 1e-3) return value.toExponential(1);
  if (size >= 1e7) return value.toExponential(2);
  if (Number.isInteger(value)) return String(value);
  return size < 1 ? value.toFixed(4) : size < 100 ? value.toFixed(2) : value.toFixed(0);
}

// Round values between two ends, both within.
function ticks(low, high, log) {
  if (log) {
    const decades = Math.log10(high / low), steps = decades > 3 ? [1] : decades > 1.2 ? [1, 3] : [1, 2, 5];
    const found = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
      for (const step of steps) {
        const value = step * 10 ** power;
        if (value >= low * 0.999 && value <= high * 1.001) found.push(value);
      }
    return found.length > 1 ? found : [low, high];
  }
  const raw = (high - low) / 5, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find(s => s * power >= raw) * power;
  const found = [];
  for (let value = Math.ceil(low / step) * step; value <= high + step * 1e-6; value += step) found.push(Number(value.toPrecision(12)));
  return found;
}

// series: [{name, points: [{x, y, label}], dots}]; categories: names along x instead of numbers; band: {low, high} of one curve.
function chart({title, xLabel, yLabel, xLog = false, yLog = false, categories = null, series, yZero = false, lines = []}) {
  const width = 640, height = 340, left = 64, right = 14, top = 14, bottom = 46;
  const all = series.flatMap(one => one.points).filter(p => Number.isFinite(p.x) && Number.isFinite(p.y) && (!yLog || p.y > 0) && (!xLog || p.x > 0));
  const root = el('figure', {class: 'chart'}, el('figcaption', {}, title));
  if (!all.length) {
    root.append(el('p', {class: 'soft'}, 'Nothing is measured here yet.'));
    return root;
  }
  const range = (values, log) => {
    let low = Math.min(...values), high = Math.max(...values);
    if (low === high) { low = log ? low / 1.5 : low - (Math.abs(low) || 1) * 0.1; high = log ? high * 1.5 : high + (Math.abs(high) || 1) * 0.1; }
    return [low, high];
  };
  let [x0, x1] = categories ? [-0.5, categories.length - 0.5] : range(all.map(p => p.x), xLog);
  let [y0, y1] = range([...all.map(p => p.y), ...lines.map(line => line.y)], yLog);
  if (!yLog && (yZero || y0 > 0 && y0 < 0.4 * y1)) y0 = 0;
  const place = (value, low, high, log) => log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  const sx = value => left + (width - left - right) * place(value, x0, x1, xLog && !categories);
  const sy = value => height - bottom - (height - top - bottom) * place(value, y0, y1, yLog);
  const plot = svg('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${title}: ${yLabel} over ${xLabel}`});
  for (const value of ticks(y0, y1, yLog)) {
    plot.append(svg('line', {class: 'grid', x1: left, x2: width - right, y1: sy(value), y2: sy(value)}),
                svg('text', {class: 'tick', x: left - 8, y: sy(value) + 4, 'text-anchor': 'end'}, plain(value)));
  }
  const along = categories ? categories.map((name, index) => [index, name]) : ticks(x0, x1, xLog).map(value => [value, plain(value)]);
  for (const [value, name] of along)
    plot.append(svg('text', {class: 'tick', x: sx(value), y: height - bottom + 18, 'text-anchor': 'middle'}, name));
  plot.append(svg('text', {class: 'axis', x: (left + width - right) / 2, y: height - 6, 'text-anchor': 'middle'}, xLabel),
              svg('text', {class: 'axis', transform: `translate(13 ${(top + height - bottom) / 2}) rotate(-90)`, 'text-anchor': 'middle'}, yLabel));
  for (const line of lines)
    plot.append(svg('line', {class: 'mark', x1: left, x2: width - right, y1: sy(line.y), y2: sy(line.y)}, svg('title', {}, line.name)));
  const key = el('p', {class: 'key'});
  series.forEach((one, index) => {
    const points = one.points.filter(p => all.includes(p)).sort((a, b) => a.x - b.x);
    const hue = `hsl(${(index * 137.5 + 28) % 360} 60% 52%)`;
    if (points.length > 1 && !one.dots)
      plot.append(svg('polyline', {class: 'curve', style: `stroke: ${hue}`, points: points.map(p => `${sx(p.x)},${sy(p.y)}`).join(' ')}));
    for (const p of points)
      plot.append(svg('circle', {cx: sx(p.x), cy: sy(p.y), r: one.dots ? 4 : 3, style: `fill: ${hue}`},
                      svg('title', {}, p.label || `${one.name}: ${plain(p.x)}, ${plain(p.y)}`)));
    const swatch = el('i', {});
    swatch.style.background = hue;
    if (one.name !== '') key.append(el('span', {}, swatch, one.name));
  });
  root.append(plot, key);
  return root;
}
