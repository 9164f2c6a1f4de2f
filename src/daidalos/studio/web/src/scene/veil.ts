// Translucent bodies: only their nearest surface is seen, not what is inside of them.
import { type Material, Mesh, MeshBasicMaterial } from "three";
import { Layer } from "./layers";

const KEY = "veil";

/** Draw a mesh so that nothing behind its nearest surface shows through it, or as usual again. */
export function setVeiled(mesh: Mesh, on: boolean): void {
  const before = mesh.userData[KEY] as Mesh | undefined;
  if (on && !before) {
    const veil = new Mesh(mesh.geometry, depthOnly([mesh.material].flat()[0] as Material));
    veil.renderOrder = Layer.VEIL;
    // What is measured, picked and freed is the mesh.
    veil.userData.sharesGeometry = veil.userData.isVeil = true;
    mesh.userData[KEY] = veil;
    mesh.add(veil);
  } else if (!on && before) {
    before.removeFromParent();
    (before.material as Material).dispose();
    delete mesh.userData[KEY];
  }
  mesh.renderOrder = on ? Layer.BODY : 0;
}

export function isVeil(mesh: Mesh): boolean {
  return mesh.userData.isVeil === true;
}

/** Among what is translucent, so that opaque things behind are drawn before it. */
function depthOnly({ side }: Material): Material {
  return new MeshBasicMaterial({ colorWrite: false, transparent: true, side });
}
