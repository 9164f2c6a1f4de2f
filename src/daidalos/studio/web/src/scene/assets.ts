// Meshes by URI: fetched through the connection, read by three.js' loaders, and cached.
import {
  Color,
  Group,
  LoadingManager,
  Mesh,
  MeshStandardMaterial,
  RepeatWrapping,
  SRGBColorSpace,
  TextureLoader,
  type Material,
  type Object3D,
  type Texture,
} from "three";
import { ColladaLoader } from "three/examples/jsm/loaders/ColladaLoader.js";
import { STLLoader } from "three/examples/jsm/loaders/STLLoader.js";
import { mergeVertices } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { Session } from "../connection/session";

const TEXTURE_TYPES: Readonly<Record<string, string>> = {
  bmp: "image/bmp",
  gif: "image/gif",
  jpeg: "image/jpeg",
  jpg: "image/jpeg",
  png: "image/png",
  svg: "image/svg+xml",
  webp: "image/webp",
};
export const DEFAULT_COLOR = 0xb9c0c9;

export class Assets {
  private readonly models = new Map<string, Promise<Object3D>>();

  constructor(private readonly session: Session) {}

  /** Load a mesh; every call returns a copy that shares its geometry with the others. */
  async load(uri: string): Promise<Object3D> {
    let model = this.models.get(uri);
    if (!model) {
      model = this.read(uri);
      this.models.set(uri, model);
      // What failed may be there the next time.
      model.catch(() => this.models.delete(uri));
    }
    return copy(await model);
  }

  /** Fetch an image as a URL that elements and textures can use. */
  async imageUrl(uri: string): Promise<string> {
    const type = TEXTURE_TYPES[extensionOf(uri)] ?? "application/octet-stream";
    return URL.createObjectURL(new Blob([await this.session.fetchAsset(uri)], { type }));
  }

  /** Load an image to put onto shapes; every call returns a texture of its own. */
  async texture(uri: string): Promise<Texture> {
    const url = await this.imageUrl(uri);
    try {
      const texture = await new TextureLoader().loadAsync(url);
      texture.colorSpace = SRGBColorSpace;
      texture.wrapS = texture.wrapT = RepeatWrapping;
      texture.anisotropy = 4;
      return texture;
    } finally {
      URL.revokeObjectURL(url);
    }
  }

  clear(): void {
    this.models.clear();
  }

  private async read(uri: string): Promise<Object3D> {
    const model = await this.parse(uri);
    model.traverse((object) => {
      if (object instanceof Mesh && !object.geometry.index) {
        // Loaders give every triangle its own corners; shared ones are drawn several times faster.
        object.geometry = mergeVertices(object.geometry);
      }
    });
    return model;
  }

  private async parse(uri: string): Promise<Object3D> {
    const data = await this.session.fetchAsset(uri);
    switch (extensionOf(uri)) {
      case "stl":
        return new Mesh(new STLLoader().parse(data), plainMaterial());
      case "obj": {
        const { OBJLoader } = await import("three/examples/jsm/loaders/OBJLoader.js");
        return withPlainMaterials(new OBJLoader().parse(new TextDecoder().decode(data)));
      }
      case "dae":
        return this.readCollada(uri, new TextDecoder().decode(data));
      case "glb":
      case "gltf":
        return this.readGltf(uri, data);
    }
    throw new Error(`${uri}: expected .stl, .dae, .obj, .gltf or .glb`);
  }

  private async readCollada(uri: string, text: string): Promise<Object3D> {
    const manager = await this.managerFor(uri, colladaImages(text));
    // ROS ignores the file's up axis: the loader must not rotate the mesh.
    const collada = new ColladaLoader(manager).parse(text.replace(/<up_axis>[^<]*<\/up_axis>/, ""), "");
    if (!collada) {
      throw new Error(`${uri}: not a COLLADA file`);
    }
    const model = new Group();
    model.add(collada.scene);
    model.traverse((object) => {
      if ("isLight" in object || "isCamera" in object) {
        object.visible = false;
      }
    });
    return model;
  }

  private async readGltf(uri: string, data: ArrayBuffer): Promise<Object3D> {
    const { GLTFLoader } = await import("three/examples/jsm/loaders/GLTFLoader.js");
    const manager = await this.managerFor(uri, uri.endsWith(".gltf") ? gltfReferences(data) : []);
    const { scene } = await new GLTFLoader(manager).parseAsync(data, "");
    return new Group().add(scene);
  }

  /** The loaders can only load from URLs: give them those of files that were fetched before. */
  private async managerFor(uri: string, references: string[]): Promise<LoadingManager> {
    const urls = new Map<string, string>();
    await Promise.all(
      references.map(async (reference) => {
        try {
          urls.set(reference, await this.imageUrl(beside(uri, decodeURI(reference))));
        } catch (error) {
          console.warn(`${uri}: ${String(error)}`);
        }
      }),
    );
    const manager = new LoadingManager();
    manager.setURLModifier((url) => urls.get(url) ?? urls.get(url.replace(/^\.\//, "")) ?? url);
    return manager;
  }
}

export function plainMaterial(color: number | Color = DEFAULT_COLOR): MeshStandardMaterial {
  return new MeshStandardMaterial({ color, roughness: 0.62, metalness: 0.08 });
}

function withPlainMaterials(model: Object3D): Object3D {
  const material = plainMaterial();
  model.traverse((object) => {
    if (object instanceof Mesh) {
      object.material = material;
    }
  });
  return model;
}

function copy(model: Object3D): Object3D {
  const clone = model.clone();
  clone.traverse((object) => {
    object.userData.sharesGeometry = true;
    if (object instanceof Mesh) {
      const materials = object.material as Material | Material[];
      object.material = Array.isArray(materials) ? materials.map((each) => each.clone()) : materials.clone();
    }
  });
  return clone;
}

/** The files of a COLLADA file's images; what surfaces name in the same way are images, not files. */
export function colladaImages(text: string): string[] {
  const blocks = [...text.matchAll(/<image\b.*?<\/image>/gs)].map((match) => match[0]);
  return blocks.flatMap((block) => {
    const file = /<init_from>(?:\s*<ref>)?\s*([^<]+?)\s*</.exec(block)?.[1];
    return file ? [file] : [];
  });
}

function gltfReferences(data: ArrayBuffer): string[] {
  const document = JSON.parse(new TextDecoder().decode(data)) as {
    buffers?: { uri?: string }[];
    images?: { uri?: string }[];
  };
  return [...(document.buffers ?? []), ...(document.images ?? [])]
    .map((entry) => entry.uri)
    .filter((uri): uri is string => uri !== undefined && !uri.startsWith("data:"));
}

/** The URI of a file that another one names relative to itself. */
export function beside(uri: string, reference: string): string {
  if (/^[a-z]+:\/\//.test(reference)) {
    return reference;
  }
  const [scheme, path] = uri.split("://", 2) as [string, string];
  const parts = path.split("/").slice(0, -1);
  for (const part of reference.split("/")) {
    if (part === "..") {
      parts.pop();
    } else if (part !== "." && part !== "") {
      parts.push(part);
    }
  }
  return `${scheme}://${parts.join("/")}`;
}

function extensionOf(uri: string): string {
  return uri.slice(uri.lastIndexOf(".") + 1).toLowerCase();
}
