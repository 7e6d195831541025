// ---- The sections ----

function showAbout() {
  const about = lab.about, size = { quick: 'quick (fewer rays, wider bounds)', full: 'full' };
  const minutes = Math.floor(about.seconds / 60), seconds = Math.round(about.seconds % 60);
  const facts = [
    ['version', about.version], ['command', about.command], ['machine', about.machine],
    ['started', about.started?.replace(/^(\d{4}-\d\d-\d\d)T(\d\d:\d\d).*Z$/, '$1 $2 UTC')],
    ['took', isNumber(about.seconds) ? (minutes ? `${minutes} min ` : '') + `${seconds} s` : null],
    ['seed', about.seed], ['size', size[about.size] ?? about.size],
  ];
  const known = facts.filter(([, value]) => value != null);
  section('about').append(...known.flatMap(([label, value]) => [element('dt', {}, label), element('dd', {}, String(value))]));
}

const timedShapes = () => shapes().filter(({ kernels }) => kernels.some(kernel => kernel.speed && kernel.accuracy));

/** A plot of a shape's kernels below the choices of its axes. */
function plotOf(shape) {
  const place = element('div');
  let [horizontal] = horizontalAxes(shape.kernels), [vertical] = verticalAxes;
  const redraw = () => place.replaceChildren(...drawPlot(shape, horizontal, vertical));
  const axes = element('div', { class: 'controls' },
    choice('x axis', horizontalAxes(shape.kernels), axis => { horizontal = axis; redraw(); }),
    choice('y axis', verticalAxes, axis => { vertical = axis; redraw(); }));
  return [axes, place];
}

function showPlot() {
  const place = element('div');
  const showShape = shape => place.replaceChildren(...plotOf(shape));
  section('plot').append(element('div', { class: 'controls' }, choice('shape', timedShapes(), showShape)), place);
}

/** A table of the kernels of each shape with the same columns. */
function showKernels() {
  const remarks = [
    timedShapes().length ? 'Mrays/s are for one thread; ns/test exclude the tree, bytes/primitive include it.' : '',
    lab.kernels.some(kernel => isAsPrinted(kernel.name))
      ? 'Names ending in “as printed” are the lecture’s programs, including their mistakes; their speed isn’t measured.' : '',
  ];
  section('kernels').append(element('p', { class: 'aside' }, remarks.filter(Boolean).join(' ')));
  for (const shape of shapes().filter(({ kernels }) => kernels.some(isMeasured))) {
    const scenes = [...new Set(shape.kernels.map(kernel => kernel.speed?.mesh).filter(Boolean))];
    section('kernels').append(element('h3', {}, shape.title),
      scenes.length ? element('p', { class: 'aside' }, `Speed was measured on: ${scenes.join('; ')}.`) : '',
      scrollBox(`Kernels: ${shape.title}`, null, sortableTable(kernelColumns(shape), shape.kernels, 'dense').table));
  }
}

function showNotes() {
  const [triangles, ...others] = shapes();
  const folded = ({ title, kernels }) => element('details', {}, element('summary', {}, `${title}: ${kernels.length}`), noteList(kernels));
  section('notes').append(noteList(triangles.kernels), ...others.map(folded));
}

const triangleMap = {
  title: 'Triangle cases', section: 'triangles', across: 'kernel',
  entries: lab.triangles, infos: lab.kernels, measures: triangleMeasures, figures: triangleFigures,
};
const meshMap = {
  title: 'Closed meshes', section: 'meshes', across: 'kernel',
  entries: lab.meshes, infos: lab.kernels, measures: meshMeasures, figures: meshFigures,
};
const orderMap = {
  title: 'Order of hits', section: 'order', across: 'kernel',
  entries: lab.order, infos: lab.kernels, measures: orderMeasures, figures: orderFigures,
};
const spawningMap = {
  title: 'Spawned rays', section: 'spawning', across: 'policy',
  entries: lab.spawning, infos: lab.policies, measures: spawningMeasures, figures: spawningFigures,
};
const shapeMap = {
  title: 'Other shapes', section: 'shapes', across: 'kernel',
  entries: lab.shapes, infos: lab.shape_kernels, measures: shapeMeasures, figures: shapeFigures,
};
const shapeSpawningMap = {
  title: 'Rays spawned on single primitives', section: 'shape_spawning', across: 'kernel',
  entries: lab.shape_spawning, infos: lab.shape_kernels, measures: spawningMeasures, figures: shapeSpawningFigures,
};

/** A heat map of each shape, as every shape has its own kernels. */
const mapsByShape = map => [...new Set(map.entries.map(entry => entry.shape))].flatMap(shape => [
  element('h3', {}, shape),
  ...heatMap({
    ...map, title: `${map.title}: ${shape}`, entries: map.entries.filter(entry => entry.shape === shape),
    infos: map.infos.filter(info => info.shape === shape),
  }),
]);

/** All cells of a map as a long table with a filter. */
function cellTable({ section: caseSection, title, entries: cells, across, infos, figures }) {
  const name = words(across, row => row[across], { style: 'name', tip: row => infoTip(infos, row[across]) });
  const { table, entries } = sortableTable([caseColumn(caseSection), name, ...figures], cells);
  const box = scrollBox(`${title}, all figures`, 'long', table);
  const filter = filterField(entries, box, across, row => `${row.case} ${row[across]}`.toLowerCase());
  return [filter, box, element('p', { class: 'aside print-only' }, 'This table is printed only if it is filtered.')];
}

function showBoxes() {
  const about = words('description', row => infoOf(lab.cases.filter(each => each.section === 'boxes'), row.case)?.about, { style: 'prose' });
  section('boxes').append(scrollBox('Boxes', null, sortableTable([caseColumn('boxes'), ...boxFigures, about], lab.boxes).table));
}

const noteList = items => element('dl', { class: 'notes' }, ...items.map(item => element('div', {},
  element('dt', {}, element('span', { class: 'name' }, item.name), item.title && item.title !== item.name ? ` — ${item.title}` : ''),
  element('dd', {}, item.summary ?? item.about ?? ''), item.source ? element('dd', { class: 'source' }, item.source) : null)));

function showCases() {
  const titles = { triangles: 'Triangle cases', meshes: 'Closed meshes', order: 'Order of hits', boxes: 'Boxes', spawning: 'Spawned rays', shapes: 'Other shapes', shape_spawning: 'Rays spawned on single primitives' };
  for (const name of new Set(lab.cases.map(each => each.section))) {
    const own = lab.cases.filter(each => each.section === name);
    section('cases').append(element('details', {}, element('summary', {}, `${titles[name] ?? name}: ${own.length}`), noteList(own)));
  }
}

/** The data that a section needs, and the function that draws it. */
const sections = {
  convergence: { needs: convergencePoints, show: showConvergence },
  scene: { needs: sceneKernels, show: showScene },
  plot: { needs: timedShapes, show: showPlot },
  kernels: { needs: () => [...lab.kernels, ...lab.shape_kernels].filter(isMeasured), show: showKernels },
  'triangles-map': { needs: () => lab.triangles, show: () => section('triangles-map').append(...heatMap(triangleMap)) },
  triangles: { needs: () => lab.triangles, show: () => section('triangles').append(...cellTable(triangleMap)) },
  meshes: { needs: () => lab.meshes, show: () => section('meshes').append(...heatMap(meshMap), ...cellTable(meshMap)) },
  order: { needs: () => lab.order, show: () => section('order').append(...heatMap(orderMap), ...cellTable(orderMap)) },
  boxes: { needs: () => lab.boxes, show: showBoxes },
  spawning: { needs: () => lab.spawning, show: () => section('spawning').append(...heatMap({ ...spawningMap, entries: lab.spawning.filter(row => row.kernel === 'exact') }), ...cellTable(spawningMap)) },
  shapes: { needs: () => lab.shapes, show: () => section('shapes').append(...mapsByShape(shapeMap), ...cellTable(shapeMap)) },
  'shape-spawning': { needs: () => lab.shape_spawning, show: () => section('shape-spawning').append(...mapsByShape(shapeSpawningMap), ...cellTable(shapeSpawningMap)) },
  packing: { needs: () => lab.packing, show: () => section('packing').append(scrollBox('Packing', null, sortableTable(packingColumns, lab.packing).table)) },
  aligned: { needs: () => lab.aligned_speed, show: () => section('aligned').append(scrollBox('Alignment', null, sortableTable(alignedColumns, lab.aligned_speed).table)) },
  policies: { needs: () => lab.policies, show: () => section('policies').append(noteList(lab.policies)) },
  notes: { needs: () => lab.kernels, show: showNotes },
  cases: { needs: () => lab.cases, show: showCases },
};

showAbout();
if (!lab.kernels.length) section('terms').remove();
for (const [id, { needs, show }] of Object.entries(sections)) if (needs().length) show(); else section(id).remove();
for (const heading of document.querySelectorAll('section > h2')) {
  document.querySelector('nav').append(element('a', { href: `#${heading.parentNode.id}` }, heading.textContent));
}
listenForTips();
