// The contract of what extends the studio: its own panels and displays fulfil it, and those of installed packages.
//
// Types only. The published daidalos-studio.d.ts is this file with the types of messages, one namespace per ROS
// package; lengths are in metres, angles in radians, times in seconds.
import type * as THREE from "three";
import type { Header } from "./generated/std_msgs";

// The graph -----------------------------------------------------------------------------------------------

/** A value that changes. */
export interface Observable<T> {
  readonly value: T;
  /** Call now and after every change; returns how to stop. */
  subscribe(call: (value: T) => void): () => void;
}

export interface TopicInfo {
  readonly name: string;
  /** In full, such as sensor_msgs/msg/LaserScan. */
  readonly type: string;
  /** False where the server does not know the definition, so that messages cannot be decoded. */
  readonly known: boolean;
}

export interface ServiceInfo {
  readonly name: string;
  readonly type: string;
}

/** A message with a header. */
export interface Stamped {
  header: Header;
}

/** A service type: both its messages. */
export interface ServiceType {
  Request: unknown;
  Response: unknown;
}

/** A message to be sent: fields that are left out get their defaults, and arrays of numbers may be plain ones. */
export type Outgoing<T> = T extends ArrayBufferView
  ? T | readonly number[]
  : T extends readonly (infer Item)[]
    ? readonly Outgoing<Item>[]
    : T extends object
      ? { readonly [Key in keyof T]?: Outgoing<T[Key]> }
      : T;

/** The connection to the ROS graph. */
export interface Session {
  readonly topics: Observable<readonly TopicInfo[]>;
  readonly services: Observable<readonly ServiceInfo[]>;
  /**
   * Subscribe to a topic, existing or not; returns how to unsubscribe.
   *
   * `keep` messages are kept while the page is busy; 1 for what only matters when it is new. `time` is when the
   * message arrived, in seconds of the graph's clock.
   */
  subscribe<M>(topic: string, keep: number, received: (message: M, time: number) => void): () => void;
  /** Publish a message of a type in full, such as std_msgs/msg/String. */
  publish(topic: string, type: string, message: unknown): void;
  /** Call a service; rejected with the reason where there is no response. */
  call<S extends ServiceType>(service: string, request: Outgoing<S["Request"]>): Promise<S["Response"]>;
  /** Read a file of a package or of a robot's description: package://… or file://…. */
  fetchAsset(uri: string): Promise<ArrayBuffer>;
}

/** The application. */
export interface Studio {
  readonly session: Session;
  /** Robot time, for stamps of messages. */
  now(): number;
  /** Call for every frame of the screen, with the page's clock; returns how to stop. */
  onFrame(call: (page: number) => void): () => void;
  /** Show a panel, the one that is open where there may only be one. */
  openPanel(id: string, params?: Record<string, unknown>): void;
}

// Panels --------------------------------------------------------------------------------------------------

export interface PanelContext {
  readonly studio: Studio;
  /** Whether the panel is on the screen; hidden ones should cost nothing. */
  readonly visible: Observable<boolean>;
  /** What the panel remembers, kept with the layout. */
  readonly params: Readonly<Record<string, unknown>>;
  remember(params: Record<string, unknown>): void;
}

/** A part of the page that can be docked anywhere: the default export of its module. */
export interface Panel {
  readonly title: string;
  /** One of the page's icons. */
  readonly icon?: string;
  /** Whether there may be several. */
  readonly many?: boolean;
  /** Put the panel into an element; returns how to remove it. */
  mount(element: HTMLElement, context: PanelContext): (() => void) | void;
}

// Displays ------------------------------------------------------------------------------------------------

export type Value = string | number | boolean;
export type Settings = Readonly<Record<string, Value>>;

interface PropertyBase {
  key: string;
  label: string;
  /** Shown only where another setting makes it matter. */
  when?: (settings: Settings) => boolean;
}

/** A setting that the user can edit. */
export type Property = PropertyBase &
  (
    | { kind: "topic" }
    | { kind: "toggle" }
    | { kind: "color" }
    | { kind: "number"; min: number; max: number; step: number; unit?: string }
    | { kind: "choice"; options: readonly (readonly [value: string, label: string])[] }
  );

/** The state of a display: idle has nothing to show yet, and that is no error. */
export interface Status {
  level: "ok" | "idle" | "warning" | "error";
  text: string;
}

/** What a display gets when it is made. */
export interface DisplayContext {
  readonly session: Session;
  theme(): "dark" | "light";
  /** Ask for the scene to be drawn again. */
  invalidate(): void;
}

/** What a display needs to know to bring itself up to date for one frame. */
export interface FrameInfo {
  /** The fixed frame, in which the scene is drawn. */
  readonly fixed: string;
  /** The moment to draw, in robot time. */
  readonly time: number | "latest";
  /** The page's clock. */
  readonly page: number;
}

/** Something that draws a part of the robot's world into the scene. */
export interface Display {
  /** What is drawn, in the fixed frame. */
  readonly object: THREE.Object3D;
  readonly status: Observable<Status>;
  /** Take over changed settings (never another topic: that makes another display). */
  restyle(settings: Settings): void;
  /** Bring the scene up to date; once per drawn frame. */
  update(frame: FrameInfo): void;
  dispose(): void;
}

/** A kind of display. */
export interface DisplayType {
  /** The message types that it shows, in full. */
  readonly messages: readonly string[];
  readonly properties: readonly Property[];
  readonly defaults: Settings;
  /** One of the page's icons. */
  readonly icon?: string;
  /**
   * For a topic of its messages that nothing shows: "appears" by itself, is "offered" (the default), or is "hidden"
   * because the type alone does not tell.
   */
  readonly discovery?: "appears" | "offered" | "hidden";
  /** The colour in which it draws, so that the list of displays is a legend. */
  legend?(settings: Settings): string | undefined;
  create(context: DisplayContext, settings: Settings): Display;
}

/** The default export of a display's module: makes the kind of display from the page's own classes. */
export type DisplayModule = (kit: DisplayKit) => DisplayType;

/** What displays of installed packages are made with: classes of the page's three.js, and its base class. */
export interface DisplayKit {
  readonly three: Pick<
    typeof THREE,
    | "BoxGeometry"
    | "BufferAttribute"
    | "BufferGeometry"
    | "CanvasTexture"
    | "CircleGeometry"
    | "Color"
    | "ConeGeometry"
    | "CylinderGeometry"
    | "DataTexture"
    | "EdgesGeometry"
    | "Float32BufferAttribute"
    | "Group"
    | "InstancedMesh"
    | "LineBasicMaterial"
    | "LineSegments"
    | "Matrix4"
    | "Mesh"
    | "MeshBasicMaterial"
    | "MeshStandardMaterial"
    | "Object3D"
    | "PlaneGeometry"
    | "Points"
    | "Quaternion"
    | "RingGeometry"
    | "ShaderMaterial"
    | "SphereGeometry"
    | "Sprite"
    | "SpriteMaterial"
    | "Vector2"
    | "Vector3"
  >;
  readonly StampedDisplay: typeof StampedDisplay;
}

/** Shows the newest message of the topic in its setting `topic`, in that message's own frame. */
declare abstract class StampedDisplay<M extends Stamped> implements Display {
  /**
   * "stamp" places what is drawn once, where its frame was at the message's stamp; "latest" lets it follow its frame.
   * `keep` messages are kept while the page is busy.
   */
  constructor(context: DisplayContext, settings: Settings, anchor: "stamp" | "latest", keep?: number);
  readonly object: THREE.Group;
  readonly status: Observable<Status>;
  protected readonly context: DisplayContext;
  protected settings: Settings;
  /** Draw a message's content into `object`, relative to its frame. */
  protected abstract show(message: M): void;
  /** A few words about what is shown. */
  protected describe(message: M): string;
  restyle(settings: Settings): void;
  update(frame: FrameInfo): void;
  dispose(): void;
}
