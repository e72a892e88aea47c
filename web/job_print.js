// On paper, the curve and the bed are drawn anew, dark on white and as wide as the sheet leaves them.
export function prepareForPaper({ bed, curve }) {
  const redraw = isPaper => () => {
    document.documentElement.classList.toggle('printing', isPaper);
    curve.rebuild();
    bed.view?.draw();
  };
  addEventListener('beforeprint', redraw(true));
  addEventListener('afterprint', redraw(false));
}
