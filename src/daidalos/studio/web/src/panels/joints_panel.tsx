// Joints: sliders for a robot's joints, the window of a joint_state_publisher_gui.
import { useEffect, useMemo } from "preact/hooks";
import type { Studio } from "../app/studio";
import type { ServiceInfo } from "../contract";
import { RangeField } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { Joints, type Joint } from "./joints/joints";
import { NodeChoice, useChosenNode } from "./node_choice";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/joints.css";

function JointsPanel(props: PanelProps) {
  const { studio, visible } = props;
  const nodes = publishersIn(studio.session.services.value);
  const chosen = useChosenNode(props);
  const node = nodes.includes(chosen.value) ? chosen.value : nodes[0];
  if (node === undefined) {
    return (
      <Empty icon="sliders" title="No joint_state_publisher_gui is running">
        <code>ros2 run joint_state_publisher_gui joint_state_publisher_gui</code>
      </Empty>
    );
  }
  return (
    <div class="column">
      {nodes.length > 1 && <NodeChoice nodes={nodes} node={node} chosen={chosen} remember={props.remember} />}
      <Sliders key={node} studio={studio} node={node} isVisible={visible.value} />
    </div>
  );
}

function Sliders({ studio, node, isVisible }: { studio: Studio; node: string; isVisible: boolean }) {
  const model = useMemo(() => new Joints(studio.session, node), []);
  useEffect(() => (isVisible ? model.follow() : undefined), [isVisible]);
  const joints = model.joints.value;
  if (joints.length === 0) {
    return (
      <Empty icon="sliders" title="No joints yet">
        {model.error || "They appear with the robot’s description."}
      </Empty>
    );
  }
  return (
    <>
      <div class="scroll joints" data-test="joints">
        {joints.map((joint) => (
          <JointRow key={joint.name} joint={joint} onChange={(value) => model.set(joint.name, value)} />
        ))}
      </div>
      <footer class="bar">
        <button
          class="button"
          title="Set every joint to a random position"
          data-test="randomize"
          onClick={() => model.randomize()}
        >
          <Icon name="marker" /> Randomize
        </button>
        <button class="button" title="Set every joint to its centre" data-test="center" onClick={() => model.center()}>
          <Icon name="focus" /> Center
        </button>
        <span class="stretch error-text ellipsis">{model.error}</span>
        <span class="faint figures">{joints.length}</span>
      </footer>
    </>
  );
}

function JointRow({ joint, onChange }: { joint: Joint; onChange(value: number): void }) {
  const { name, lower, upper, value, unit } = joint;
  return (
    <label class="joint" data-joint={name}>
      <span class="joint-name ellipsis" title={name}>
        {name}
      </span>
      <RangeField label={`Position of ${name}`} min={lower} max={upper} {...{ value, unit, onChange }} />
      <span class="joint-limits faint figures">
        <span>{lower.toFixed(2)}</span>
        <span>{upper.toFixed(2)}</span>
      </span>
    </label>
  );
}

/** Nodes that can centre and randomize joints. */
function publishersIn(services: readonly ServiceInfo[]): string[] {
  const names = new Set(services.filter(({ type }) => type === "std_srvs/srv/Empty").map(({ name }) => name));
  return [...names]
    .filter((name) => name.endsWith("/randomize"))
    .map((name) => name.replace(/\/randomize$/, ""))
    .filter((node) => names.has(`${node}/center`));
}

export default {
  id: "joints",
  title: "Joints",
  icon: "sliders",
  mount: withPreact(JointsPanel),
} satisfies BuiltInPanel;
