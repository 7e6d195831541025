// ---- The error of pictures against time ----

const convergencePoints = () => lab.convergence?.points ?? [];
const convergenceColumns = [
  words('setting', row => row.setting, { isHead: true }),
  column('samples per pixel', row => row.samples, { text: count }),
  column('CPU s', row => row.cpu_s),
  column('relative RMSE', row => row.relative_rmse),
];

/** A line for each setting, over logarithmic axes; the error of the reference is a horizontal line. */
function convergencePlot() {
  const points = convergencePoints().filter(point => point.cpu_s > 0 && point.relative_rmse > 0);
  if (points.length === 0) return element('p', { class: 'aside' }, 'No picture differs from the reference.');
  const { relative_error: error } = lab.convergence.reference, errors = points.map(point => point.relative_rmse);
  const x = logScale(points.map(point => point.cpu_s), FRAME.left + 12, FRAME.right - 12);
  const y = logScale(error > 0 ? [...errors, error] : errors, FRAME.bottom - 12, FRAME.top);
  const zero = error > 0 ? { py: y.at(error), label: 'reference' } : null;
  const names = [...new Set(points.map(point => point.setting))];
  const lines = names.map(name => {
    const own = points.filter(point => point.setting === name).map(point => ({ point, px: x.at(point.cpu_s), py: y.at(point.relative_rmse) }));
    const marks = own.map(({ point, px, py }) => withTip(
      svg('g', { class: 'point', tabindex: 0, role: 'img', 'aria-label': `${name}, ${point.samples} samples: ${figure(point.relative_rmse)} after ${figure(point.cpu_s)} s` },
        svg('path', { class: 'mark', d: MARKS.f32, transform: `translate(${px} ${py})` })),
      () => ({ title: name, facts: factsOf(convergenceColumns, point) })));
    const last = own.at(-1);
    return svg('g', {}, svg('path', { class: 'front', d: own.map(({ px, py }, index) => `${index ? 'L' : 'M'}${px} ${py}`).join('') }), ...marks,
      svg('text', { class: 'label', x: Math.min(last.px, FRAME.right) - 8, y: last.py - 8, 'text-anchor': 'end' }, name));
  });
  const axes = axisNodes(x, y, { title: 'CPU time, s' }, { title: 'relative RMSE' }, zero);
  return svg('svg', { class: 'plot', viewBox: `0 0 ${FRAME.width} ${FRAME.height}`, role: 'group', 'aria-label': 'relative RMSE against CPU time' }, ...axes, ...lines);
}

function showConvergence() {
  const { size: [width, height], reference } = lab.convergence;
  section('convergence').append(
    element('p', { class: 'aside' }, `${lab.file ?? ''}: ${width} × ${height} pixels. Reference: ${reference.setting}, ${count(reference.samples)} samples per pixel, ${figure(reference.cpu_s)} CPU s, relative standard error ${figure(reference.relative_error)}.`),
    convergencePlot(), scrollBox('Error against time', null, sortableTable(convergenceColumns, convergencePoints()).table));
}
