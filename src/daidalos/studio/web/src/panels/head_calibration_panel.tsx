// Calibration: guides through the calibration of a moving head, as the node head_calibration asks.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Studio } from "../app/studio";
import type { HeadCalibration } from "../generated/daidalos_msgs";
import { Empty } from "../ui/empty";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/head_calibration.css";

const TYPE = "daidalos_msgs/msg/HeadCalibration";
const DEGREE = Math.PI / 180;
const BAD_ERROR_M = 0.005;
const KEYS: Record<string, string> = {
  ArrowLeft: "left",
  ArrowRight: "right",
  ArrowUp: "up",
  ArrowDown: "down",
  "+": "+",
  "-": "-",
  Enter: "enter",
  u: "undo",
};
const ARROWS: readonly (readonly [command: string, text: string])[] = [
  ["left", "←"],
  ["up", "↑"],
  ["down", "↓"],
  ["right", "→"],
];

type Send = (command: string) => void;

function HeadCalibrationPanel({ studio, visible }: PanelProps) {
  const topic = studio.session.topics.value.find(({ type }) => type === TYPE)?.name;
  return topic ? (
    <Session key={topic} studio={studio} topic={topic} isVisible={visible.value} />
  ) : (
    <Empty icon="focus" title="No calibration is running">
      <code>ros2 run daidalos_lighting head_calibration</code>
    </Empty>
  );
}

function Session({ studio: { session }, topic, isVisible }: { studio: Studio; topic: string; isVisible: boolean }) {
  const state = useSignal<HeadCalibration | undefined>(undefined);
  useEffect(
    () => (isVisible ? session.subscribe<HeadCalibration>(topic, 1, (next) => (state.value = next)) : undefined),
    [isVisible],
  );
  const send: Send = (command) =>
    session.publish(topic.replace(/state$/, "command"), "std_msgs/msg/String", { data: command });
  const press = (event: KeyboardEvent) => {
    const command = KEYS[event.key];
    if (command && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      event.stopPropagation();
      send(command);
    }
  };
  const now = state.value;
  return (
    <div class="scroll head-calibration" tabIndex={0} onKeyDown={press} data-test="head-calibration">
      {now && (
        <>
          <Task now={now} />
          <Controls now={now} send={send} />
          {now.report && (
            <p role="status" class={now.is_written ? "" : "faint"}>
              {now.report}
            </p>
          )}
          {now.has_result && <Result now={now} />}
        </>
      )}
    </div>
  );
}

function Task({ now }: { now: HeadCalibration }) {
  const { x, y, z } = now.point;
  return (
    <>
      <h3>{now.head}</h3>
      <p data-test="task">
        {now.is_complete
          ? `All ${now.total} directions are confirmed.`
          : `${now.confirmed + 1} of ${now.total}: put the spot on [${[x, y, z].map(short).join(", ")}], ` +
            (now.is_flipped ? "flipped" : "straight")}
      </p>
      <p class="figures faint">
        pan {degrees(now.pan, 3)} · tilt {degrees(now.tilt, 3)} · step {degrees(now.step, 2)}
      </p>
    </>
  );
}

function Controls({ now, send }: { now: HeadCalibration; send: Send }) {
  const button = (command: string, text: string, isEnabled: boolean) => (
    <button class="button" data-command={command} disabled={!isEnabled} onClick={() => send(command)}>
      {text}
    </button>
  );
  return (
    <>
      <div class="head-calibration-row">
        {ARROWS.map(([command, text]) => button(command, text, !now.is_complete))}
        {button("+", "Larger step", true)}
        {button("-", "Smaller step", true)}
      </div>
      <div class="head-calibration-row">
        {button("enter", "Confirm", !now.is_complete)}
        {button("undo", "Undo", now.confirmed > 0)}
        {button("propose", "Propose a point", now.is_complete && now.has_result)}
        {button("write", "Write", now.is_complete && now.has_result)}
      </div>
    </>
  );
}

function Result({ now }: { now: HeadCalibration }) {
  const isLength = (name: string) => name.length === 1;
  return (
    <>
      <table class="figures">
        <tbody>
          {now.names.map((name, i) => {
            const [value, deviation] = [now.values[i] ?? 0, now.deviations[i] ?? 0];
            return (
              <tr key={name}>
                <td>{name.replace("_", " ")}</td>
                <td>{isLength(name) ? `${value.toFixed(4)} m` : degrees(value, 3)}</td>
                <td class="faint">± {isLength(name) ? `${(1e3 * deviation).toFixed(1)} mm` : degrees(deviation, 3)}</td>
              </tr>
            );
          })}
          <tr>
            <td>residual</td>
            <td>{degrees(now.residual, 4)}</td>
            <td class="faint">condition {now.condition.toFixed(0)}</td>
          </tr>
        </tbody>
      </table>
      <p>Expected pointing error over the table [mm]</p>
      <Errors errors={[...now.expected_errors]} columns={now.columns} />
    </>
  );
}

/** Expected errors as a picture of the table from above: x to the right, y upwards. */
function Errors({ errors, columns }: { errors: readonly number[]; columns: number }) {
  const rows = errors.length / columns;
  return (
    <svg class="head-calibration-table" viewBox={`0 0 ${columns * 4} ${rows * 3}`} role="img" aria-label="Errors">
      {errors.map((error, i) => {
        const [x, y] = [(i % columns) * 4, (rows - 1 - Math.floor(i / columns)) * 3];
        return (
          <g key={i}>
            <rect x={x} y={y} width="3.8" height="2.8" fill={color(error)} />
            <text x={x + 1.9} y={y + 1.8} text-anchor="middle" font-size="1.2">
              {(1e3 * error).toFixed(1)}
            </text>
          </g>
        );
      })}
    </svg>
  );
}

/** Green for no error, yellow, and red from BAD_ERROR_M on. */
function color(error: number): string {
  return `hsl(${120 * (1 - Math.min(error / BAD_ERROR_M, 1))} 70% 60%)`;
}

function degrees(angle: number, digits: number): string {
  return `${(angle / DEGREE).toFixed(digits)}°`;
}

function short(value: number): string {
  return String(Math.round(1e4 * value) / 1e4);
}

export default {
  id: "head_calibration",
  title: "Head calibration",
  icon: "focus",
  mount: withPreact(HeadCalibrationPanel),
} satisfies BuiltInPanel;
