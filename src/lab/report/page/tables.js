// ---- Tables ----

const collator = new Intl.Collator('en', { numeric: true });

/** Compares in either direction with nulls last; equal values keep the report's order. */
function compareBy(each, isAscending) {
  return (a, b) => {
    const [x, y] = [each.value(a.row) ?? null, each.value(b.row) ?? null];
    if (x === null || y === null) return (x === null) - (y === null) || a.index - b.index;
    const order = isNumber(x) && isNumber(y) ? x - y : collator.compare(String(x), String(y));
    return (isAscending ? order : -order) || a.index - b.index;
  };
}

function tableCell(each, row, isStart) {
  const value = each.value(row);
  const style = classes(each.isText && 'text', each.isHead && 'name', each.style, isStart && 'starts', isAsPrinted(value) && 'printed');
  const cell = element(each.isHead ? 'th' : 'td', { class: style, scope: each.isHead && 'row' }, String(each.text(value, row)));
  if (each.tip) withTip(cell, () => each.tip(row));
  each.decorate?.(cell, value, row);
  return cell;
}

function groupRow(columns) {
  const cells = [];
  for (const [index, each] of columns.entries()) {
    // The first column stays in place while the others scroll, so it never shares a cell with them.
    if (index > 1 && each.group === columns[index - 1].group) cells.at(-1).colSpan += 1;
    else cells.push(element('th', { scope: 'colgroup', class: classes(each.isHead && 'corner', each.group && 'starts') }, each.group ?? ''));
  }
  return element('tr', { class: 'groups' }, ...cells);
}

/** A table sorted by clicking its headers, without columns that have no figures. The caller may hide rows through `entries`. */
function sortableTable(allColumns, rows, className = null) {
  const columns = allColumns.filter(each => !each.isTipOnly && rows.some(row => each.value(row) != null));
  const startsGroup = index => index > 0 && columns[index].group !== columns[index - 1].group;
  const rowNode = row => element('tr', {}, ...columns.map((each, index) => tableCell(each, row, startsGroup(index))));
  const entries = rows.map((row, index) => ({ row, index, node: rowNode(row) }));
  const body = element('tbody', {}, ...entries.map(entry => entry.node));
  const heads = columns.map((each, index) => {
    // Not a <button>: Chromium omits buttons when it repeats the header on a new printed page.
    const button = element('span', { role: 'button', tabindex: 0 }, each.title);
    const head = element('th', { scope: 'col', class: classes(each.isText && 'text', each.isHead && 'corner', each.isTurned && 'turned',
      startsGroup(index) && 'starts', isAsPrinted(each.title) && 'printed') }, button);
    if (each.headTip) withTip(head, each.headTip);
    button.addEventListener('click', () => sortBy(each, head));
    button.addEventListener('keydown', event => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      sortBy(each, head);
    });
    return head;
  });
  function sortBy(each, head) {
    const next = { null: 'ascending', ascending: 'descending', descending: null }[head.getAttribute('aria-sort')];
    for (const other of heads) other.removeAttribute('aria-sort');
    if (next) head.setAttribute('aria-sort', next);
    const order = next ? compareBy(each, next === 'ascending') : (a, b) => a.index - b.index;
    body.append(...[...entries].sort(order).map(entry => entry.node));
  }
  const head = element('thead', {}, columns.some(each => each.group) ? groupRow(columns) : null, element('tr', {}, ...heads));
  return { table: element('table', { class: className }, head, body), entries };
}

const scrollBox = (label, style, ...children) =>
  element('div', { class: classes('box', style), tabindex: 0, role: 'region', 'aria-label': label }, ...children);

/** A search field that hides the rows of a table that don't contain all of its words. */
function filterField(entries, box, across, textOf) {
  const field = element('input', { type: 'search', placeholder: 'one or more words' });
  const status = element('span', { class: 'status', role: 'status' });
  const apply = () => {
    const wanted = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const { row, node } of entries) node.hidden = !wanted.every(word => textOf(row).includes(word));
    const shown = entries.filter(entry => !entry.node.hidden).length;
    status.textContent = `${count(shown)} of ${count(entries.length)} rows`;
    box.classList.toggle('filtered', wanted.length > 0);
  };
  field.addEventListener('input', apply);
  apply();
  return element('div', { class: 'controls' }, element('label', {}, `Filter by case or ${across}: `, field), status);
}

let choiceCount = 0;
/** Radio buttons; calls `onChange` with the selected option, immediately with the first. */
function choice(legend, options, onChange) {
  const name = `choice-${choiceCount++}`;
  const labels = options.map((option, index) => {
    const input = element('input', { type: 'radio', name, checked: index === 0 ? '' : null });
    input.addEventListener('change', () => onChange(option));
    return element('label', {}, input, option.title);
  });
  onChange(options[0]);
  return element('fieldset', {}, element('legend', {}, legend), ...labels);
}

// ---- Heat maps ----

const rate = (title, value) => ({ title, value, firstExponent: 0, boundOf });
const triangleMeasures = [
  rate('wrong /M', wrongPerMillion),
  rate('missed /M', row => row.missed_per_million),
  rate('false hits /M', row => row.false_per_million),
  { title: 't error p99, ulps', value: row => row.t_ulps?.p99, firstExponent: 0 },
  { title: 'barycentric error p99', value: row => row.barycentric_error?.p99, firstExponent: -7 },
  { title: 'gap between barycentric point and t, p99', value: row => row.gap?.p99, firstExponent: -7 },
];
const meshMeasures = [
  rate('missed /M', row => row.missed_per_million),
  { ...rate('doubled /M', row => row.doubled_per_million), boundOf: doubledBound },
];
const orderMeasures = [
  rate('wrong nearest /M', row => row.wrong_nearest_per_million),
  rate('wrong crossings /M', row => row.wrong_crossings_per_million),
];
const spawningMeasures = [
  rate('self-hits /M', row => row.self_hits_per_million),
  { title: 'largest height / size', value: row => row.height_max, firstExponent: -7 },
];
const shapeMeasures = [
  rate('wrong /M', wrongPerMillion),
  { title: 't error p99, ulps', value: row => row.t_ulps?.p99, firstExponent: 0 },
  { title: 'error / size, p99', value: row => row.error_in_sizes?.p99, firstExponent: -7 },
];

/** 0 for a zero, then one level per decade from 1 to 7; level 2 starts at 10^firstExponent. */
function levelOf(value, firstExponent) {
  if (!isNumber(value)) return 'none';
  return value === 0 ? 0 : Math.max(1, Math.min(7, Math.floor(Math.log10(Math.abs(value))) - firstExponent + 2));
}

function levelLegend({ title, firstExponent }) {
  const power = index => short(Number(`1e${firstExponent + index}`));
  const decades = [0, 1, 2, 3, 4].map(index => `${power(index)} – ${power(index + 1)}`);
  const labels = ['0', `< ${power(0)}`, ...decades, `≥ ${power(5)}`];
  const name = element('strong', { class: 'print-only' }, title);
  const swatches = labels.map((label, level) => element('span', { class: `level-${level}` }, label));
  return [name, ...swatches, element('span', { class: 'level-none' }, `${DASH} not measured`)];
}

/** A heat map of cases by kernel or policy (`map.across`), showing one of `map.measures` at a time. */
function heatMap(map) {
  const names = [...new Set([...map.infos.map(info => info.name), ...map.entries.map(entry => entry[map.across])])]
    .filter(name => map.entries.some(entry => entry[map.across] === name));
  const rows = [...new Set(map.entries.map(entry => entry.case))].map(name => {
    const own = map.entries.filter(entry => entry.case === name);
    const sizes = own.map(entry => entry.n).filter(isNumber);
    return { case: name, n: sizes.length ? Math.min(...sizes) : null, cells: new Map(own.map(entry => [entry[map.across], entry])) };
  });
  const box = scrollBox(`${map.title}, heat map`, null), legend = element('div', { class: 'scale' });
  const cellColumn = (name, measure) => column(name, row => row.cells.has(name) ? measure.value(row.cells.get(name)) : null, {
    text: short, isTurned: true, headTip: () => infoTip(map.infos, name),
    decorate(cell, value, row) {
      cell.classList.add(`level-${levelOf(value, measure.firstExponent)}`);
      const entry = row.cells.get(name);
      if (entry) withTip(cell, () => ({ title: `${name} on ${row.case}`, facts: factsOf(map.figures, entry) }));
    },
  });
  const show = measure => {
    const fixed = [caseColumn(map.section), column('n', row => row.n, { text: count, style: 'plain' })];
    if (measure.boundOf) fixed.push(column('bound of 0', measure.boundOf, { text: bound => `<\u00a0${figure(bound)}`, style: 'plain' }));
    box.replaceChildren(sortableTable([...fixed, ...names.map(name => cellColumn(name, measure))], rows, 'heat').table);
    legend.replaceChildren(...levelLegend(measure));
  };
  return [element('div', { class: 'controls' }, choice('Show', map.measures, show), legend), box];
}
