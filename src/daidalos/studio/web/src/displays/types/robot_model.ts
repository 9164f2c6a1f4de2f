// RobotModel: the robot's links, at their poses by TF.
import {
  Box3,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  Group,
  Mesh,
  SphereGeometry,
  SRGBColorSpace,
  type Material,
  type MeshPhongMaterial,
  type MeshStandardMaterial,
  type Object3D,
} from "three";
import URDFLoader, { type URDFCollider, type URDFLink, type URDFVisual } from "urdf-loader";
import type { String as StringMessage } from "../../generated/std_msgs";
import { plainMaterial } from "../../scene/assets";
import { setShadowing } from "../../scene/shadowing";
import { isVeil, setVeiled } from "../../scene/veil";
import type { Settings } from "../../contract";
import { disposeTree, place, type DisplayContext, type FrameInfo, type BuiltInDisplay } from "../display";
import { flag, number } from "../settings";
import { TopicDisplay } from "../topic_display";

export class RobotModel extends TopicDisplay<StringMessage> {
  private readonly links = new Map<string, Group>();
  private description = "";
  private problems: string[] = [];
  private waiting = 0;

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings);
  }

  protected override receive({ data }: StringMessage): void {
    if (data !== this.description) {
      this.description = data;
      this.build();
    }
  }

  override restyle(settings: Settings): void {
    super.restyle(settings);
    this.style();
  }

  override update(frame: FrameInfo): void {
    const missing: string[] = [];
    for (const [name, link] of this.links) {
      const found = place(this.context, link, frame.fixed, name, frame.time, true);
      if (link.visible !== found) {
        link.visible = found;
        this.context.invalidate();
      }
      if (!found && link.children.length) {
        missing.push(name);
      }
    }
    this.reportMissing(missing, frame.fixed);
  }

  override bounds(): Box3 {
    const box = new Box3();
    for (const link of this.links.values()) {
      if (link.visible) {
        box.union(new Box3().setFromObject(link));
      }
    }
    return box;
  }

  private reportMissing(missing: string[], fixed: string): void {
    if (this.problems.length) {
      this.report("error", this.problems[0] as string);
    } else if (this.links.size === 0) {
      this.report("idle", "no robot description yet");
    } else if (missing.length) {
      const more = missing.length > 1 ? ` and ${missing.length - 1} more links` : "";
      this.report("warning", `no transform from ${missing[0]}${more} to ${fixed}`);
    } else {
      this.report("ok", this.waiting ? `${this.waiting} meshes to come` : `${this.links.size} links`);
    }
  }

  private clear(): void {
    disposeTree(this.object);
    this.object.clear();
    this.links.clear();
    this.problems = [];
    this.waiting = 0;
    this.context.invalidate();
  }

  private build(): void {
    this.clear();
    const description = this.description;
    const loader = new URDFLoader();
    loader.parseCollision = true;
    loader.packages = (name) => `package://${name}`;
    loader.loadMeshCb = (uri, _manager, material, done) => {
      const capsule = capsuleNamed(uri);
      if (capsule) {
        paint(capsule, material);
        done(capsule);
        return;
      }
      this.waiting++;
      this.context.assets
        .load(uri)
        .then((model) => {
          if (this.description === description) {
            if (uri.toLowerCase().endsWith(".stl")) {
              paint(model, material);
            }
            done(model);
            this.style();
          }
        })
        .catch((error: Error) => this.problems.push(error.message))
        .finally(() => {
          this.waiting--;
          this.context.invalidate();
        });
    };
    try {
      const element = robotElement(description);
      nameCapsules(element);
      const textures = takeTextures(element);
      const robot = loader.parse(element);
      for (const [name, link] of Object.entries(robot.links)) {
        this.addLink(name, link);
      }
      textures.forEach((uri, material) => this.texture(uri, material, description));
    } catch (error) {
      this.problems.push(`robot description: ${error instanceof Error ? error.message : String(error)}`);
    }
    this.style();
  }

  /** Detach a link's shapes from the loader's tree: TF gives the pose of every link. */
  private addLink(name: string, link: URDFLink): void {
    const group = new Group();
    group.visible = false;
    for (const child of [...link.children] as (URDFVisual | URDFCollider)[]) {
      if ("isURDFVisual" in child || "isURDFCollider" in child) {
        group.add(child);
        useStandardMaterials(child);
      }
    }
    this.links.set(name, group);
    this.object.add(group);
  }

  /** Put an image onto the shapes of a material, as soon as it is there. */
  private texture(uri: string, material: string, description: string): void {
    this.context.assets
      .texture(uri)
      .then((map) => {
        if (this.description === description) {
          this.object.traverse((object) => {
            if (object instanceof Mesh && !object.userData.sharesGeometry) {
              const surface = object.material as MeshStandardMaterial;
              if (surface.name === material) {
                surface.map = map;
                surface.color.set(0xffffff);
                surface.needsUpdate = true;
              }
            }
          });
          this.context.invalidate();
        }
      })
      .catch((error: Error) => this.problems.push(error.message));
  }

  private style(): void {
    const alpha = number(this.settings, "alpha");
    for (const link of this.links.values()) {
      for (const child of link.children) {
        const collides = "isURDFCollider" in child;
        child.visible = flag(this.settings, collides ? "collision" : "visual");
        child.traverse((object) => styleMesh(object, alpha, collides));
      }
    }
    this.context.invalidate();
  }
}

function robotElement(description: string): Element {
  const { documentElement: root } = new DOMParser().parseFromString(description, "text/xml");
  const flaw = root.querySelector("parsererror");
  if (flaw) {
    throw new Error(`not well-formed XML: ${(flaw.textContent ?? "").trim().split("\n")[1] ?? ""}`);
  }
  if (root.nodeName !== "robot") {
    throw new Error(`expected <robot>, found <${root.nodeName}>`);
  }
  return root;
}

const CAPSULE = "capsule:";

/** The loader does not support capsules: pass them as meshes with their dimensions in the name. */
function nameCapsules(robot: Element): void {
  for (const element of [...robot.getElementsByTagName("capsule")]) {
    const mesh = element.ownerDocument.createElement("mesh");
    const size = ["radius", "length"].map((key) => element.getAttribute(key) ?? "0");
    mesh.setAttribute("filename", `package://${CAPSULE}/${size.join(" ")}`);
    element.replaceWith(mesh);
  }
}

/** Make the capsule that a mesh's name stands for, along z. */
function capsuleNamed(uri: string): Mesh | null {
  const [, size] = uri.split(`${CAPSULE}/`);
  const [radius, length] = (size ?? "").split(" ").map(Number);
  return radius && length !== undefined
    ? new Mesh(new CapsuleGeometry(radius, length, 12, 32).rotateX(Math.PI / 2))
    : null;
}

/** Remove textures from the description and return them by material: the loader does not support `package://`. */
export function takeTextures(robot: Element): Map<string, string> {
  const found = new Map<string, string>();
  for (const element of [...robot.getElementsByTagName("texture")]) {
    const material = element.parentElement;
    const [name, uri] = [material?.getAttribute("name"), element.getAttribute("filename")];
    if (material?.nodeName === "material" && name && uri) {
      found.set(name, uri);
      element.remove();
    }
  }
  return found;
}

/** The loader's materials are Phong with colours taken as linear; URDF's are what a screen shows. */
function useStandardMaterials(root: Object3D): void {
  const made = new Map<Material, Material>();
  root.traverse((object) => {
    if (object instanceof Mesh && !object.userData.sharesGeometry) {
      const old = object.material as MeshPhongMaterial;
      const material = made.get(old) ?? standardFrom(old);
      made.set(old, material);
      object.material = material;
      smooth(object);
    }
  });
}

/** The loader's round shapes have so few sides that a ball on a post of its width shows teeth. */
function smooth(object: Mesh): void {
  if (object.geometry instanceof SphereGeometry) {
    object.geometry = new SphereGeometry(1, 96, 48);
  } else if (object.geometry instanceof CylinderGeometry) {
    object.geometry = new CylinderGeometry(1, 1, 1, 96);
  }
}

function standardFrom(old: MeshPhongMaterial): Material {
  const { r, g, b } = old.color;
  // White is what the loader gives to shapes without a material of their own.
  const material =
    old.name || r + g + b < 3 ? plainMaterial(new Color().setRGB(r, g, b, SRGBColorSpace)) : plainMaterial();
  material.name = old.name;
  material.opacity = old.opacity;
  material.userData.opacity = old.opacity;
  return material;
}

/** STL files have no colours: the link's material is the mesh's. */
function paint(model: Object3D, material: Material): void {
  model.traverse((object) => {
    if (object instanceof Mesh) {
      object.material = standardFrom(material as MeshPhongMaterial);
    }
  });
}

type Surface = Material & { color?: Color; emissive?: Color; map?: unknown; wireframe?: boolean };

/** Most robots are nearly black, and would vanish on a dark floor: what is darker than this glows a little. */
const DARK = 0.1;
const GLOW = 0x4a525e;

/** Deep colours are not dark. */
function brightness({ r, g, b }: Color): number {
  return Math.max(r, g, b);
}

function styleMesh(object: Object3D, alpha: number, collides: boolean): void {
  if (!(object instanceof Mesh) || isVeil(object)) {
    return;
  }
  setShadowing(object, !collides);
  object.userData.pickable = !collides;
  for (const material of [object.material].flat() as Surface[]) {
    material.userData.opacity ??= material.opacity;
    material.opacity = (material.userData.opacity as number) * alpha;
    material.transparent = material.opacity < 1;
    material.depthWrite = material.opacity >= 1;
    if (!collides && !material.map && material.color && brightness(material.color) < DARK) {
      material.emissive?.set(GLOW);
    }
    if (collides) {
      material.wireframe = true;
      material.color?.set(0xe2a355);
    }
  }
  setVeiled(object, !collides && alpha < 1);
}

export default {
  id: "RobotModel",
  icon: "robot",
  discovery: "hidden",
  messages: ["std_msgs/msg/String"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    { key: "visual", label: "Visual", kind: "toggle" },
    { key: "collision", label: "Collision", kind: "toggle" },
    { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
  ],
  defaults: { topic: "/robot_description", visual: true, collision: false, alpha: 1 },
  create: (context, settings) => new RobotModel(context, settings),
} satisfies BuiltInDisplay;
