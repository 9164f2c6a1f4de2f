// SlamToolbox: slam_toolbox's maps and pose graphs, saved, loaded, corrected by hand and merged, as in RViz's panel.
import { type Signal, useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useMemo } from "preact/hooks";
import type { Studio } from "../app/studio";
import type { PoseWithCovarianceStamped } from "../generated/geometry_msgs";
import { Log } from "../generated/rcl_interfaces";
import { NodeParameters } from "../parameters/node_parameters";
import { Transform } from "../tf/buffer";
import { Choice, NumberField, TextField, Toggle } from "../ui/editors";
import { Empty } from "../ui/empty";
import { NodeChoice, useChosenNode } from "./node_choice";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import { type Pose2, SlamNode, slamNodes, type Start, toPlanar } from "./slam_toolbox/slam_node";
import "../styles/slam_toolbox.css";

const STARTS: readonly (readonly [value: StartChoice, label: string])[] = [
  ["dock", "Start at dock"],
  ["pose", "Start at pose"],
  ["current", "Start at current pose"],
  ["localize", "Localize at pose"],
];
const FAR_M = 1e5;
const DEGREE = Math.PI / 180;

type StartChoice = Start | "current";

function SlamToolboxPanel(props: PanelProps) {
  const { studio, visible } = props;
  const nodes = slamNodes(studio.session.services.value);
  const chosen = useChosenNode(props);
  const node = nodes.includes(chosen.value) ? chosen.value : (nodes[0] ?? "");
  return (
    <div class="column">
      {nodes.length > 1 && <NodeChoice nodes={nodes} node={node} chosen={chosen} remember={props.remember} />}
      {node ? (
        <Controls key={node} studio={studio} name={node} isVisible={visible.value} />
      ) : (
        <Empty icon="map" title="No node of slam_toolbox">
          It appears as soon as one is running.
        </Empty>
      )}
    </div>
  );
}

function Controls({ studio, name, isVisible }: { studio: Studio; name: string; isVisible: boolean }) {
  const node = useMemo(() => new SlamNode(studio.session, name), []);
  const parameters = useMemo(() => new NodeParameters(studio.session, name), []);
  useEffect(() => {
    if (!isVisible) {
      return undefined;
    }
    const stops = [node.follow(), ...(node.has("pause_new_measurements") ? [parameters.follow()] : [])];
    return () => stops.forEach((stop) => stop());
  }, [isVisible]);
  return (
    <>
      <div class="scroll slam" aria-busy={node.isBusy.value}>
        <Measurements node={node} parameters={parameters} />
        <SavedMap node={node} />
        <PoseGraph node={node} parameters={parameters} studio={studio} isVisible={isVisible} />
        <Submaps node={node} />
      </div>
      <div class="slam-reports" role="status">
        {node.reports.value.map(({ text, level }, i) => (
          <div
            key={i}
            class={`ellipsis ${level >= Log.ERROR ? "error-text" : level < Log.WARN ? "faint" : ""}`}
            title={text}
          >
            {text}
          </div>
        ))}
      </div>
    </>
  );
}

/** What the node does with new scans, and key scans moved by hand. */
function Measurements({ node, parameters }: { node: SlamNode; parameters: NodeParameters }) {
  if (!node.has("pause_new_measurements")) {
    return null;
  }
  const isOn = (name: string) => parameters.all.value.some((each) => each.name === name && each.value === true);
  const isInteractive = isOn("interactive_mode");
  return (
    <Section title="Scans">
      <label class="slam-row">
        <span class="stretch">Accept new scans</span>
        <Toggle
          label="Accept new scans"
          on={!isOn("paused_new_measurements")}
          onChange={() => void node.togglePause()}
        />
      </label>
      <label class="slam-row">
        <span class="stretch">Interactive mode</span>
        <Toggle
          label="Interactive mode"
          on={isInteractive}
          disabled={!node.has("toggle_interactive_mode")}
          onChange={() => void node.toggleInteractive()}
        />
      </label>
      {isInteractive && <Moved node={node} label="Key scan" />}
      <div class="slam-row">
        <Action node={node} service="clear_changes" act={() => node.clearChanges()}>
          Clear Changes
        </Action>
        <Action node={node} service="manual_loop_closure" act={() => node.applyChanges()}>
          Save Changes
        </Action>
        <Action node={node} service="clear_queue" act={() => node.clearQueue()}>
          Clear Queue
        </Action>
      </div>
    </Section>
  );
}

/** A key scan or a submap, chosen by its number, and where it is to be. */
function Moved({ node, label }: { node: SlamNode; label: string }) {
  const places = node.movable.value;
  const numbers = [...places.keys()];
  const chosen = useSignal<number | undefined>(undefined);
  const number = chosen.value ?? Math.max(0, ...numbers);
  const pose = useSignal<Pose2>({ x: 0, y: 0, theta: 0 });
  useEffect(() => void node.showMovable(), []);
  useEffect(() => {
    pose.value = places.get(number) ?? pose.value;
  }, [places, number]);
  return (
    <>
      <div class="slam-row">
        <span class="stretch">{label}</span>
        <NumberField
          label={label}
          value={number}
          min={Math.min(number, ...numbers)}
          max={Math.max(number, ...numbers)}
          step={1}
          onChange={(typed) => (chosen.value = Math.round(typed))}
        />
        <button
          class="button"
          data-slam="move"
          disabled={!places.has(number)}
          onClick={() => node.move(number, pose.value)}
        >
          Move
        </button>
      </div>
      <PoseFields label={label} pose={pose} />
    </>
  );
}

function SavedMap({ node }: { node: SlamNode }) {
  const name = useSignal("map");
  return node.has("save_map") ? (
    <Section title="Map">
      <div class="slam-row">
        <TextField
          label="Name of the map"
          placeholder="Name of the map"
          value={name.value}
          onChange={(text) => (name.value = text)}
        />
        <Action node={node} service="save_map" isReady={name.value !== ""} act={() => node.saveMap(name.value)}>
          Save Map
        </Action>
      </div>
    </Section>
  ) : null;
}

interface PoseGraphProps {
  node: SlamNode;
  parameters: NodeParameters;
  studio: Studio;
  isVisible: boolean;
}

function PoseGraph({ node, parameters, studio, isVisible }: PoseGraphProps) {
  const file = useSignal("");
  const start = useSignal<StartChoice>("dock");
  const pose = useSignal<Pose2>({ x: 0, y: 0, theta: 0 });
  useEffect(
    () =>
      // The 2D Pose Estimate of the view fills the fields in.
      isVisible
        ? studio.session.subscribe<PoseWithCovarianceStamped>("/initialpose", 1, (estimate) => {
            pose.value = toPlanar(estimate.pose.pose);
          })
        : undefined,
    [isVisible],
  );
  if (!node.has("serialize_map")) {
    return null;
  }
  const load = async () => {
    if (start.value !== "current") {
      return node.deserialize(file.value, start.value, pose.value);
    }
    const frame = (name: string) => String(parameters.all.peek().find((each) => each.name === name)?.value ?? name);
    const [map, base] = [frame("map_frame"), frame("base_frame")];
    const current = new Transform();
    if (!studio.tf.lookup(map, base, "latest", current)) {
      node.add({ text: studio.tf.explain(map, base, "latest"), level: Log.ERROR });
      return undefined;
    }
    pose.value = { x: current.position.x, y: current.position.y, theta: current.yaw };
    return node.deserialize(file.value, "pose", pose.value);
  };
  return (
    <Section title="Pose graph">
      <div class="slam-row">
        <TextField
          label="File, without suffix"
          placeholder="File, without suffix"
          value={file.value}
          onChange={(text) => (file.value = text)}
        />
        <Action node={node} service="serialize_map" isReady={file.value !== ""} act={() => node.serialize(file.value)}>
          Serialize
        </Action>
      </div>
      <div class="slam-row">
        <Choice
          label="Start"
          value={start.value}
          options={STARTS}
          onChange={(value) => (start.value = value as StartChoice)}
        />
        <Action node={node} service="deserialize_map" isReady={file.value !== ""} act={load}>
          Deserialize
        </Action>
      </div>
      {(start.value === "pose" || start.value === "localize") && <PoseFields label="Start" pose={pose} />}
    </Section>
  );
}

function Submaps({ node }: { node: SlamNode }) {
  const file = useSignal("");
  return node.has("add_submap") ? (
    <Section title="Submaps">
      <div class="slam-row">
        <TextField
          label="File of the submap"
          placeholder="File, without suffix"
          value={file.value}
          onChange={(text) => (file.value = text)}
        />
        <Action node={node} service="add_submap" isReady={file.value !== ""} act={() => node.addSubmap(file.value)}>
          Add Submap
        </Action>
      </div>
      <Moved node={node} label="Submap" />
      <div class="slam-row">
        <Action node={node} service="merge_submaps" act={() => node.mergeSubmaps()}>
          Generate Map
        </Action>
      </div>
    </Section>
  ) : null;
}

function Section({ title, children }: { title: string; children: ComponentChildren }) {
  return (
    <section>
      <h3 class="faint">{title}</h3>
      {children}
    </section>
  );
}

interface ActionProps {
  node: SlamNode;
  service: string;
  isReady?: boolean;
  act(): Promise<void>;
  children: ComponentChildren;
}

/** A button that calls a service; this kind of node may not have it. */
function Action({ node, service, isReady = true, act, children }: ActionProps) {
  const isServed = node.has(service);
  return (
    <button
      class="button"
      data-slam={service}
      disabled={!isServed || !isReady || node.isBusy.value}
      title={isServed ? "" : `${node.name} has no service ${service}`}
      onClick={() => void act()}
    >
      {children}
    </button>
  );
}

/** Position [m] and heading, edited in degrees. */
function PoseFields({ label, pose }: { label: string; pose: Signal<Pose2> }) {
  const change = (changed: Partial<Pose2>) => (pose.value = { ...pose.value, ...changed });
  const { x, y, theta } = pose.value;
  const round = (value: number) => Number(value.toFixed(3));
  const limits = { min: -FAR_M, max: FAR_M, step: 0.1 };
  return (
    <div class="slam-row slam-pose">
      <NumberField label={`${label}: x`} unit="m" value={round(x)} {...limits} onChange={(x) => change({ x })} />
      <NumberField label={`${label}: y`} unit="m" value={round(y)} {...limits} onChange={(y) => change({ y })} />
      <NumberField
        label={`${label}: heading`}
        unit="°"
        value={round(theta / DEGREE)}
        min={-360}
        max={360}
        step={5}
        onChange={(typed) => change({ theta: typed * DEGREE })}
      />
    </div>
  );
}

export default {
  id: "slam_toolbox",
  title: "SlamToolbox",
  icon: "map",
  mount: withPreact(SlamToolboxPanel),
} satisfies BuiltInPanel;
