// ---- The plot ----

const FRAME = { left: 96, right: 1176, top: 34, bottom: 470, width: 1200, height: 520 };
const ZERO_BAND_PX = 44;
const MARKS = { // by precision; others are diamonds
  f32: 'M-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0z',
  f64: 'M-4.5 -4.5h9v9h-9z',
  other: 'M0 -6.5L6.5 0L0 6.5L-6.5 0z',
};

const horizontalAxes = kernels => [
  { title: 'time relative to fast', value: kernel => kernel.speed?.time_relative_to_fast },
  ...workloads(kernels).map(name => ({ title: `Mrays/s, ${name} rays`, value: kernel => kernel.speed?.mrays_per_s?.[name], isMoreBetter: true })),
];
const verticalAxes = [
  { title: 'wrong decisions per million', value: kernel => kernel.accuracy?.wrong_per_million, isRate: true },
  { title: 't error p99 of the worst case, ulps', value: kernel => kernel.accuracy?.t_ulps_p99 },
];

function linearScale(values, from, to) {
  const least = Math.min(...values), most = Math.max(...values), margin = (most - least || most || 1) * 0.05;
  const low = Math.max(0, least - margin), high = most + margin;
  const rough = (high - low) / 8, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= rough);
  const ticks = [];
  for (let index = Math.ceil(low / step); index * step <= high; index++) ticks.push(Number((index * step).toPrecision(12)));
  return { at: value => from + (value - low) / (high - low) * (to - from), ticks };
}

function logScale(values, from, to) {
  let low = Math.log10(Math.min(...values)) - 0.15, high = Math.log10(Math.max(...values)) + 0.15;
  if (high - low < 1) [low, high] = [low - 0.35, high + 0.35];
  const factors = high - low > 4 ? [1] : [1, 2, 5], ticks = [];
  for (let exponent = Math.floor(low); exponent <= high; exponent++) {
    for (const factor of factors) ticks.push(Number(`${factor}e${exponent}`));
  }
  const at = value => from + (Math.log10(value) - low) / (high - low) * (to - from);
  return { at, ticks: ticks.filter(tick => Math.log10(tick) >= low && Math.log10(tick) <= high), isLog: true };
}

/** The points that no other point beats in both figures, from the fastest to the most accurate. */
function paretoFront(points, isMoreBetter) {
  const slowness = point => isMoreBetter ? -point.x : point.x;
  let best = Infinity;
  return [...points].sort((a, b) => slowness(a) - slowness(b) || a.y - b.y).filter(point => point.y < best && ((best = point.y), true));
}

const overlap = (a, b) => Math.max(0, Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x))
  * Math.max(0, Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y));

const gap = (box, { px, py }) => Math.hypot(Math.max(box.x - px, 0, px - box.x - box.width), Math.max(box.y - py, 0, py - box.y - box.height));

/** A rectangle for each label near its point, away from other labels, points and the front if possible. */
function placeLabels(points, obstacles) {
  const candidates = points.map(({ px, py, label }) => {
    const width = label.length * 7.2 + 2, height = 15, found = [];
    for (const distance of [8, 14, 22, 32, 46, 62, 82]) for (let turn = 0; turn < 16; turn++) {
      const [cos, sin] = [Math.cos(turn * Math.PI / 8), Math.sin(turn * Math.PI / 8)];
      const x = px + cos * (distance + width / 2) - width / 2, y = py + sin * (distance + height / 2) - height / 2;
      const leader = [0.3, 0.5, 0.7, 0.9].map(part => ({ x: px + cos * distance * part - 1, y: py + sin * distance * part - 1, width: 2, height: 2 }));
      const isOutside = x < FRAME.left || x + width > FRAME.right || y < FRAME.top || y + height > FRAME.bottom;
      // A label close to another point, or whose leader passes another point, would be read as that point's.
      const isMisread = other => gap({ x, y, width, height }, other) < Math.min(distance + 8, 24) || leader.some(dot => gap(dot, other) < 7);
      const strangers = points.filter(other => (other.px !== px || other.py !== py) && isMisread(other)).length;
      const hidden = obstacles.reduce((total, obstacle) => total + overlap({ x, y, width, height }, obstacle), 0);
      found.push({ x, y, width, height, leader, cost: distance - 2 * cos + hidden + 60 * strangers + (isOutside ? 1e5 : 0) });
    }
    return found;
  });
  const chosen = [];
  const clash = (a, b) => overlap(a, b) * 4 + (overlap(a, b) ? 200 : 0) + a.leader.filter(dot => overlap(dot, b)).length * 40
    + b.leader.filter(dot => overlap(dot, a)).length * 40;
  const cost = (candidate, own) => chosen.reduce((total, other, index) => total + (index === own ? 0 : clash(candidate, other)), candidate.cost);
  // In the second and third round, earlier labels give way to later ones.
  for (let round = 0; round < 3; round++) candidates.forEach((found, own) => {
    const costs = found.map(candidate => cost(candidate, own));
    chosen[own] = found[costs.indexOf(Math.min(...costs))];
  });
  return chosen;
}

function leaderLine({ px, py }, label) {
  const x = Math.max(label.x, Math.min(px, label.x + label.width)), y = Math.max(label.y + 2, Math.min(py, label.y + label.height - 2));
  return Math.hypot(x - px, y - py) > 13 ? svg('path', { class: 'leader', d: `M${px} ${py}L${x} ${y}` }) : null;
}

function pointNode(shape, point, label) {
  const { kernel, px, py } = point, facts = factsOf(kernelColumns(shape), kernel), title = kernel.title ?? kernel.name;
  const spoken = [title, ...facts.map(fact => fact.join(' '))].join('; ');
  const node = svg('g', { class: classes('point', kernel.tier && 'tier'), tabindex: 0, role: 'img', 'aria-label': spoken },
    svg('path', { class: 'mark', d: MARKS[kernel.precision] ?? MARKS.other, transform: `translate(${px} ${py})` }),
    svg('text', { class: 'label', x: label.x + 1, y: label.y + 11.5 }, point.label));
  return withTip(node, () => ({ title, about: kernel.summary, facts }));
}

const tickText = tick => tick >= 1e-3 && tick < 1e3 ? String(tick) : figure(tick);

function axisNodes(x, y, horizontal, vertical, zero) {
  const nodes = [];
  const text = (content, x, y, anchor, name = 'tick') => nodes.push(svg('text', { class: name, x, y, 'text-anchor': anchor }, content));
  const line = (d, name = 'grid') => nodes.push(svg('path', { class: name, d }));
  for (const tick of x.ticks) { line(`M${x.at(tick)} ${FRAME.top}V${FRAME.bottom}`); text(tickText(tick), x.at(tick), FRAME.bottom + 18, 'middle'); }
  for (const tick of y.ticks) { line(`M${FRAME.left} ${y.at(tick)}H${FRAME.right}`); text(tickText(tick), FRAME.left - 8, y.at(tick) + 4, 'end'); }
  if (zero) { line(`M${FRAME.left} ${zero.py}H${FRAME.right}`, 'zero-line'); text(zero.label, FRAME.left - 8, zero.py + 4, 'end'); }
  const better = horizontal.isMoreBetter ? 'higher is better →' : '← lower is better';
  text(`${horizontal.title}${x.isLog ? ', logarithmic' : ''}  (${better})`, FRAME.right, FRAME.bottom + 40, 'end', 'axis');
  text(`${vertical.title}, logarithmic  (↓ lower is better)`, 8, 18, 'start', 'axis');
  return nodes;
}

function drawPlot(shape, horizontal, vertical) {
  const points = shape.kernels.map(kernel => ({ kernel, x: horizontal.value(kernel), y: vertical.value(kernel) }))
    .filter(point => isNumber(point.x) && isNumber(point.y));
  if (points.length === 0) return [element('p', { class: 'aside' }, 'No kernel has both figures.')];
  const zeros = points.filter(point => point.y === 0), others = points.filter(point => point.y > 0);
  const bound = Math.max(...zeros.map(point => boundOf(point.kernel.accuracy) ?? 0));
  const zero = zeros.length ? { py: FRAME.bottom - 16, label: vertical.isRate ? below(bound) : '0' } : null;

  // On a linear axis, a kernel ten times as slow would squeeze the others together.
  const xs = points.map(point => point.x), isWide = Math.min(...xs) > 0 && Math.max(...xs) > 10 * Math.min(...xs);
  const x = (isWide ? logScale : linearScale)(xs, FRAME.left + 12, FRAME.right - 12);
  const y = others.length ? logScale(others.map(point => point.y), FRAME.bottom - (zero ? ZERO_BAND_PX : 0), FRAME.top) : { ticks: [] };
  for (const point of points) {
    const { name, tier } = point.kernel;
    Object.assign(point, { px: x.at(point.x), py: point.y > 0 ? y.at(point.y) : zero.py, label: tier && tier !== name ? `${name} · ${tier}` : name });
  }

  const front = paretoFront(points, horizontal.isMoreBetter), slowEdge = horizontal.isMoreBetter ? FRAME.left : FRAME.right;
  const steps = front.map((point, index) => index ? `H${point.px}V${point.py}` : `M${point.px} ${FRAME.top}V${point.py}`);
  const frontRects = front.map((point, index) => {
    const end = front[index + 1]?.px ?? slowEdge;
    return { x: Math.min(point.px, end), y: point.py - 1, width: Math.abs(end - point.px), height: 2 };
  });
  const markRects = points.map(({ px, py }) => ({ x: px - 8, y: py - 8, width: 16, height: 16 }));
  const labels = placeLabels(points, [...markRects, ...frontRects]);
  const name = `${shape.title}: ${vertical.title} against ${horizontal.title}`;
  const picture = svg('svg', { class: 'plot', viewBox: `0 0 ${FRAME.width} ${FRAME.height}`, role: 'group', 'aria-label': name },
    ...axisNodes(x, y, horizontal, vertical, zero), svg('path', { class: 'front', d: `${steps.join('')}H${slowEdge}` }),
    ...points.map((point, index) => leaderLine(point, labels[index])), ...points.map((point, index) => pointNode(shape, point, labels[index])));
  return [picture, plotLegend(shape, points, front)];
}

function plotLegend(shape, points, front) {
  const key = (style, d, text) => element('span', {},
    svg('svg', { viewBox: '-11 -7 22 14', class: style }, svg('path', { class: style === 'front' ? 'front' : 'mark', d })), text);
  const absent = shape.kernels.filter(kernel => !points.some(point => point.kernel === kernel)).map(kernel => kernel.name);
  return element('div', {}, element('div', { class: 'legend' },
    key('', MARKS.f32, 'f32'), key('', MARKS.f64, 'f64'), key('', MARKS.other, 'adaptive'), key('tier', MARKS.f32, 'filled, bold: a tier’s kernel'),
    key('front', 'M-11 -5H0V5H11', `Pareto front: ${front.map(point => point.kernel.name).join(', ')}`)),
  absent.length ? element('p', { class: 'aside' }, `Not in the plot because a figure is missing: ${absent.join(', ')}.`) : '');
}
