// Where the tumour's edge is shown once the tissue is stretched.

import {pointsOf} from "./geometry.js";

const kName = "tumour's edge";

/** The edge as it lies on the tissue that is shown: {label, points, isClosed}; without points where it is not known.
 *  Where only its place at rest is known although the tissue has moved, the label says so.
 *  @param edge  {points, isClosed, isRest}, as shownEdge() gives it
 *  @param share  how far the tissue is on its way from rest to stretched, 0..1 */
export function edgeAt({plan, stretch}, edge, share) {
  const isPulled = share > 0.995,
    isSame = plan && stretch && plan.revision === stretch.revision;
  if (isPulled && isSame) return {label: kName, points: pointsOf(plan.edge), isClosed: true};
  if (!edge.isRest) return {label: kName, points: isPulled ? edge.points : [], isClosed: edge.isClosed};
  return {label: share < 0.005 ? kName : `${kName}, as it was at rest`, points: edge.points, isClosed: edge.isClosed};
}
