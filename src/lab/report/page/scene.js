// ---- The kernels in the user's scene ----

const sceneKernels = () => lab.scene?.kernels ?? [];

function showScene() {
  const shape = { title: 'scene', kernels: sceneKernels() };
  const note = [`${lab.file}: ${lab.scene.contents}.`, lab.scene.note].filter(Boolean).join(' ');
  section('scene').append(element('p', { class: 'aside' }, note), ...plotOf(shape),
    scrollBox('Kernels in the scene', null, sortableTable(kernelColumns(shape), shape.kernels, 'dense').table));
}
