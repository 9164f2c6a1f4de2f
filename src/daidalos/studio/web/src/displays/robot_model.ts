// RobotModel: the robot's links, each where TF says that it is.
import { Color, Group, Mesh, SRGBColorSpace, type Material, type MeshPhongMaterial, type Object3D } from "three";
import URDFLoader, { type URDFCollider, type URDFLink, type URDFVisual } from "urdf-loader";
import type { StringMessage } from "../ros/messages";
import { plainMaterial } from "../scene/assets";
import { disposeTree, place, type DisplayContext, type FrameInfo } from "./display";
import type { DisplayType } from "./registry";
import { flag, number, type Settings } from "./settings";
import { TopicDisplay } from "./topic_display";

class RobotModel extends TopicDisplay<StringMessage> {
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
    this.tell(missing, frame.fixed);
  }

  private tell(missing: string[], fixed: string): void {
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
      const robot = loader.parse(robotElement(description));
      for (const [name, link] of Object.entries(robot.links)) {
        this.addLink(name, link);
      }
    } catch (error) {
      this.problems.push(`robot description: ${error instanceof Error ? error.message : String(error)}`);
    }
    this.style();
  }

  /** Take a link's shapes out of the loader's tree: TF moves each link by itself. */
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

/** The loader's materials are Phong with colours taken as linear; URDF's are what a screen shows. */
function useStandardMaterials(root: Object3D): void {
  const made = new Map<Material, Material>();
  root.traverse((object) => {
    if (object instanceof Mesh && !object.userData.sharesGeometry) {
      const old = object.material as MeshPhongMaterial;
      const material = made.get(old) ?? standardFrom(old);
      made.set(old, material);
      object.material = material;
    }
  });
}

function standardFrom(old: MeshPhongMaterial): Material {
  const { r, g, b } = old.color;
  // White is what the loader gives to shapes without a material of their own.
  const material =
    old.name || r + g + b < 3 ? plainMaterial(new Color().setRGB(r, g, b, SRGBColorSpace)) : plainMaterial();
  material.map = old.map;
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
  if (!(object instanceof Mesh)) {
    return;
  }
  object.castShadow = !collides;
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
}

export const ROBOT_MODEL: DisplayType = {
  type: "RobotModel",
  messages: ["std_msgs/msg/String"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    { key: "visual", label: "Visual", kind: "toggle" },
    { key: "collision", label: "Collision", kind: "toggle" },
    { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
  ],
  defaults: { topic: "/robot_description", visual: true, collision: false, alpha: 1 },
  create: (context, settings) => new RobotModel(context, settings),
};
