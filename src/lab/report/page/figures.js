'use strict';

// ---- Building nodes. Text is always added as text nodes: names may contain `<` and `&`. ----

function build(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) if (value != null && value !== false) node.setAttribute(name, value);
  node.append(...children.filter(child => child != null));
  return node;
}
const element = (tag, attributes = {}, ...children) => build(document.createElement(tag), attributes, children);
const svg = (tag, attributes = {}, ...children) => build(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
const classes = (...names) => names.filter(Boolean).join(' ') || null;
const section = id => document.getElementById(id);

// ---- The data ----

/** The report's JSON; missing arrays are treated as empty. */
function readLab() {
  const lists = { kernels: [], cases: [], triangles: [], meshes: [], order: [], boxes: [], policies: [], spawning: [], shape_kernels: [], shapes: [], shape_spawning: [], packing: [], aligned_speed: [] };
  const read = JSON.parse(section('lab').textContent);
  const present = Object.entries(read).filter(([, value]) => value != null);
  return { about: {}, ...lists, ...Object.fromEntries(present) };
}
const lab = readLab();
/** The workloads that were traced for some of these kernels. */
const workloads = kernels => ['primary', 'bounce', 'random'].filter(name => kernels.some(kernel => kernel.speed?.mrays_per_s?.[name] > 0));
/** The shapes with their kernels, triangles first. */
function shapes() {
  const others = lab.shape_kernels.filter(kernel => kernel.shape !== 'triangle');
  const named = [...new Set(others.map(kernel => kernel.shape))].map(title => ({ title, kernels: others.filter(kernel => kernel.shape === title) }));
  return [{ title: 'triangle', kernels: lab.kernels }, ...named];
}
const isMeasured = kernel => kernel.speed != null || kernel.accuracy != null;
const infoOf = (infos, name) => infos.find(info => info.name === name);
const isAsPrinted = name => / as printed$/.test(name);

// ---- Numbers ----

const DASH = '–';
const THIN_SPACE = '\u202f'; // non-breaking
const grouped = digits => digits.replace(/\B(?=(\d{3})+$)/g, THIN_SPACE);
const isNumber = value => typeof value === 'number' && Number.isFinite(value);

/** A count with all its digits. */
const count = value => isNumber(value) ? grouped(String(Math.round(value))) : DASH;

/** A measured figure with three significant digits. */
function figure(value) {
  if (!isNumber(value)) return DASH;
  if (value === 0) return '0';
  const rounded = Number(value.toPrecision(3)), size = Math.abs(rounded);
  if (size < 1e-3 || size >= 1e5) return rounded.toExponential(2).replace(/\.?0*e\+?/, 'e');
  if (size >= 1e3) return grouped(String(rounded));
  return Number.isInteger(value) ? String(value) : rounded.toPrecision(3);
}

/** A figure of at most five characters, for the cells of a heat map. */
function short(value) {
  if (!isNumber(value)) return DASH;
  const size = Math.abs(value);
  if (value === 0) return '0';
  if (size < 0.095 || size >= 999500) return value.toExponential(0).replace('e+', 'e');
  if (size < 9.95) return String(Number(value.toFixed(1)));
  if (size < 999.5) return String(Math.round(value));
  return (value / 1000).toFixed(size < 9950 ? 1 : 0).replace(/\.0$/, '') + 'k';
}

const boundOf = row => row.bound_per_million ?? (row.n > 0 ? 3e6 / row.n : null);
const below = bound => `0 (<\u00a0${figure(bound)})`;
const doubledBound = row => row.doubled_bound_per_million ?? null;
const perMillion = (value, row) => value === 0 ? below(boundOf(row)) : figure(value);
const sum = (a, b) => a == null && b == null ? null : (a ?? 0) + (b ?? 0);
const wrongPerMillion = row => sum(row.missed_per_million, row.false_per_million);

// ---- Columns: each figure is defined once, for tables and tooltips ----

const column = (title, value, options = {}) => ({ title, value, text: figure, ...options });
const words = (title, value, options = {}) => column(title, value, { isText: true, text: text => text ?? DASH, ...options });
const spread = (group, field, parts = ['p50', 'p99', 'max']) => parts.map(part => column(part, row => row[field]?.[part], { group }));
const decidedIn = (of, options = { text: perMillion }) => [
  column('f64', row => of(row)?.in_f64_per_million, { group: 'decided in, /M', ...options }),
  column('integers', row => of(row)?.in_integers_per_million, { group: 'decided in, /M', ...options }),
];

function kernelColumns({ title: shape, kernels }) {
  const accuracy = (title, field, options) => column(title, kernel => kernel.accuracy?.[field], options);
  const overAll = `all ${shape} cases`, ulps = 't, worst case, ulps';
  return [
    words('kernel', kernel => kernel.name, { isHead: true, tip: kernel => ({ ...infoTip(kernels, kernel.name), facts: factsOf(kernelColumns({ title: shape, kernels }), kernel) }) }),
    words('tier', kernel => kernel.tier),
    words('in', kernel => kernel.precision),
    column('time / fast', kernel => kernel.speed?.time_relative_to_fast, { group: 'speed' }),
    column('ns/test', kernel => kernel.speed?.ns_per_test, { group: 'speed' }),
    ...workloads(kernels).map(name => column(name, kernel => kernel.speed?.mrays_per_s?.[name], { group: 'Mrays/s' })),
    column('bytes/primitive', kernel => kernel.speed?.bytes_per_triangle, { group: 'memory' }),
    ...decidedIn(kernel => kernel.speed, { isTipOnly: true }),
    accuracy('n', 'n', { text: count, group: overAll }),
    accuracy('hits', 'hits', { text: count, group: overAll, isTipOnly: true }),
    accuracy('missed', 'missed', { text: count, group: overAll }),
    accuracy('false', 'false_hits', { text: count, group: overAll }),
    accuracy('wrong /M', 'wrong_per_million', { text: (value, kernel) => perMillion(value, kernel.accuracy), group: overAll }),
    accuracy('p99', 't_ulps_p99', { group: ulps }),
    accuracy('max', 't_ulps_max', { group: ulps }),
    accuracy('max', 'barycentric_max', { group: 'barycentric' }),
    accuracy('count', 'non_finite', { text: count, group: 'non-finite' }),
  ];
}

const caseColumn = name => words('case', row => row.case, { isHead: true, tip: row => infoTip(lab.cases.filter(each => each.section === name), row.case) });

const triangleFigures = [
  column('n', row => row.n, { text: count }),
  column('hits', row => row.hits, { text: count }),
  column('missed', row => row.missed, { text: count }),
  column('false', row => row.false_hits, { text: count }),
  column('wrong /M', wrongPerMillion, { text: perMillion }),
  ...spread('t error, ulps', 't_ulps'),
  ...spread('barycentric error', 'barycentric_error'),
  ...spread('gap between barycentric point and t', 'gap'),
  column('count', row => row.non_finite, { text: count, group: 'non-finite' }),
  ...decidedIn(row => row),
];
const meshFigures = [
  column('n', row => row.n, { text: count }),
  column('missed', row => row.missed, { text: count }),
  column('missed /M', row => row.missed_per_million, { text: perMillion }),
  column('doubled', row => row.doubled, { text: count }),
  column('doubled /M', row => row.doubled_per_million, { text: (value, row) => value === 0 ? below(doubledBound(row)) : figure(value) }),
  ...decidedIn(row => row),
];
const orderFigures = [
  column('n', row => row.n, { text: count }),
  column('ties', row => row.ties, { text: count }),
  column('count', row => row.wrong_nearest, { text: count, group: 'wrong nearest' }),
  column('/M', row => row.wrong_nearest_per_million, { text: perMillion, group: 'wrong nearest' }),
  column('count', row => row.wrong_crossings, { text: count, group: 'wrong crossings' }),
  column('/M', row => row.wrong_crossings_per_million, { text: perMillion, group: 'wrong crossings' }),
];
const boxFigures = [
  column('n', row => row.n, { text: count }),
  column('lost', row => row.lost, { text: count }),
  column('lost /M', row => row.lost_per_million, { text: perMillion }),
];
const spawningFigures = [
  words('kernel', row => row.kernel, { style: 'name' }),
  column('n', row => row.n, { text: count }),
  column('self-hits', row => row.self_hits, { text: count }),
  column('self-hits /M', row => row.self_hits_per_million, { text: perMillion }),
  column('p50', row => row.height_p50, { group: 'height / size' }),
  column('max', row => row.height_max, { group: 'height / size' }),
];
const shapeFigures = [
  words('shape', row => row.shape, { style: 'name' }),
  column('n', row => row.n, { text: count }),
  column('hits', row => row.hits, { text: count }),
  column('missed', row => row.missed, { text: count }),
  column('false', row => row.false_hits, { text: count }),
  column('wrong /M', wrongPerMillion, { text: perMillion }),
  ...spread('t error, ulps', 't_ulps'),
  ...spread('error / size', 'error_in_sizes'),
];
const shapeSpawningFigures = [
  words('shape', row => row.shape, { style: 'name' }),
  column('n', row => row.n, { text: count }),
  column('self-hits', row => row.self_hits, { text: count }),
  column('self-hits /M', row => row.self_hits_per_million, { text: perMillion }),
  column('beyond an edge', row => row.edge_hits, { text: count }),
  column('p50', row => row.height_p50, { group: 'height / size' }),
  column('max', row => row.height_max, { group: 'height / size' }),
];
const packingColumns = [
  words('kernel', row => row.kernel, { isHead: true, tip: row => infoTip(lab.shape_kernels.filter(info => info.shape === row.shape), row.kernel) }),
  words('shape', row => row.shape, { style: 'name' }),
  column('n', row => row.n, { text: count }),
  column('ns', row => row.ns_per_primitive, { group: 'per primitive' }),
  column('bytes', row => row.bytes_per_primitive, { group: 'per primitive' }),
  column('bytes of the tree', row => row.tree_bytes_per_primitive, { group: 'per primitive' }),
];
const alignedColumns = [
  words('kernel', row => row.kernel, { isHead: true, tip: row => infoTip(lab.shape_kernels.filter(info => info.shape === row.shape), row.kernel) }),
  words('shape', row => row.shape, { style: 'name' }),
  words('on', row => row.speed.mesh),
  column('time / fast', row => row.speed.time_relative_to_fast),
  ...['primary', 'bounce', 'random'].map(name => column(name, row => row.speed.mrays_per_s[name], { group: 'Mrays/s' })),
];

// ---- Tooltips: { title, about, facts: [[label, text], …] }, built when shown ----

const tips = new WeakMap();
function withTip(node, tip) {
  node.classList.add('has-tip');
  tips.set(node, tip);
  return node;
}

const factsOf = (columns, row) => columns.filter(each => !each.isHead && each.value(row) != null)
  .map(each => [each.group ? `${each.group}: ${each.title}` : each.title, each.text(each.value(row), row)]);
function infoTip(infos, name) {
  const info = infoOf(infos, name);
  return { title: info?.title ?? name, about: info?.summary ?? info?.about, facts: [] };
}

function showTip(target) {
  const box = section('tooltip'), tip = tips.get(target)();
  const facts = tip.facts.flatMap(([label, text]) => [element('dt', {}, label), element('dd', {}, text)]);
  box.replaceChildren(element('strong', {}, tip.title), tip.about ? element('p', {}, tip.about) : '', element('dl', {}, ...facts));
  box.hidden = false;
  const at = target.getBoundingClientRect(), size = box.getBoundingClientRect();
  const isRoomBelow = at.bottom + 6 + size.height < innerHeight;
  box.style.left = `${Math.max(4, Math.min(at.left, innerWidth - size.width - 8))}px`;
  box.style.top = `${isRoomBelow ? at.bottom + 6 : Math.max(4, at.top - size.height - 6)}px`;
}

function listenForTips() {
  const hide = () => { section('tooltip').hidden = true; };
  const follow = event => {
    const target = event.target.closest?.('.has-tip');
    if (target) showTip(target); else hide();
  };
  for (const name of ['pointerover', 'focusin']) document.addEventListener(name, follow);
  document.addEventListener('focusout', hide);
  document.documentElement.addEventListener('pointerleave', hide);
  // Focus may scroll its target into view; the tooltip follows.
  const move = () => { if (tips.has(document.activeElement)) showTip(document.activeElement); else hide(); };
  document.addEventListener('scroll', move, { capture: true, passive: true });
  document.addEventListener('keydown', event => { if (event.key === 'Escape') hide(); });
}
