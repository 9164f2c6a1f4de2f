// Shadows of bodies, on the ground and on one another.
import type { Object3D } from "three";
import { CASTERS } from "./flat_shadows";
import { beginsFine } from "./graphics";

/** Make a body cast its shadow or not; only a graphics card shows those that fall on other bodies. */
export function setShadowing(body: Object3D, casts: boolean): void {
  body.castShadow = casts;
  if (casts) {
    body.layers.enable(CASTERS);
  } else {
    body.layers.disable(CASTERS);
  }
  body.receiveShadow = casts && beginsFine;
}
