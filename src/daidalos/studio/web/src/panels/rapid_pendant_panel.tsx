// Pendant: a program in RAPID with its pointers, signals, jogging and positions, as the node rapid_pendant has them.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Studio } from "../app/studio";
import type { RapidPendant } from "../generated/daidalos_msgs";
import { Empty } from "../ui/empty";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/rapid_pendant.css";

const TYPE = "daidalos_msgs/msg/RapidPendant";
const DEGREE = Math.PI / 180;
const FRAMES = ["axis", "base", "tool", "wobj"];
const INCREMENTS = ["small", "medium", "large"];
const WAYS = ["x", "y", "z", "rx", "ry", "rz"];

type Send = (command: string) => void;
type Props = { now: RapidPendant; send: Send };

function RapidPendantPanel({ studio, visible }: PanelProps) {
  const topic = studio.session.topics.value.find(({ type }) => type === TYPE)?.name;
  return topic ? (
    <Pendant key={topic} studio={studio} topic={topic} isVisible={visible.value} />
  ) : (
    <Empty icon="robot" title="No pendant is running">
      <code>ros2 run daidalos_rapid rapid_pendant --ros-args -p program:=FILE.mod</code>
    </Empty>
  );
}

function Pendant({ studio: { session }, topic, isVisible }: { studio: Studio; topic: string; isVisible: boolean }) {
  const state = useSignal<RapidPendant | undefined>(undefined);
  useEffect(
    () => (isVisible ? session.subscribe<RapidPendant>(topic, 10, (next) => (state.value = next)) : undefined),
    [isVisible],
  );
  const send: Send = (command) =>
    session.publish(topic.replace(/state$/, "command"), "std_msgs/msg/String", { data: command });
  const now = state.value;
  return (
    <div class="scroll rapid-pendant" data-test="rapid-pendant">
      {now && (
        <>
          <Program now={now} send={send} />
          {now.report && (
            <p role="status" data-test="report">
              {now.report}
            </p>
          )}
          {now.question && <Question now={now} send={send} />}
          {now.screen.length > 0 && <pre data-test="screen">{now.screen.join("\n")}</pre>}
          <Jogging now={now} send={send} />
          <Positions now={now} send={send} />
          <Signals now={now} send={send} />
        </>
      )}
    </div>
  );
}

function Program({ now, send }: Props) {
  const isRunning = now.state === "running" || now.state === "asking";
  return (
    <section>
      <div class="rapid-pendant-row">
        <Command command="start" text="Start" isEnabled={!isRunning} send={send} />
        <Command command="stop" text="Stop" isEnabled={now.state === "running"} send={send} />
        <Command command="step" text="Step" isEnabled={!isRunning} send={send} />
        <Command command="main" text="PP to main" isEnabled send={send} />
        <Choice name="mode" options={["manual", "auto"]} value={now.mode} send={send} />
        <span class="faint" data-test="state">
          {now.state}
        </span>
      </div>
      <ol class="rapid-pendant-program" start={now.first_line} aria-label={now.module}>
        {now.lines.map((line, i) => {
          const number = now.first_line + i;
          const isHere = number === now.program_pointer;
          return (
            <li key={number} aria-current={isHere ? "step" : undefined}>
              <span class="rapid-pendant-pointers" aria-hidden="true">
                {isHere ? "➤" : ""}
                {number === now.motion_pointer ? "⚙" : ""}
              </span>
              <code>{line}</code>
            </li>
          );
        })}
      </ol>
    </section>
  );
}

function Question({ now, send }: Props) {
  const text = useSignal("");
  const answer = () => send(`answer ${text.value}`);
  return (
    <section role="dialog" aria-label={now.question} class="rapid-pendant-question">
      <p data-test="question">{now.question}</p>
      <div class="rapid-pendant-row">
        {now.choices.length > 0 ? (
          now.choices.map(
            (choice, i) =>
              choice && (
                <button key={i} class="button" data-command={`answer ${i + 1}`} onClick={() => send(`answer ${i + 1}`)}>
                  {choice}
                </button>
              ),
          )
        ) : (
          <>
            <input
              aria-label="Answer"
              value={text.value}
              onInput={({ currentTarget }) => (text.value = currentTarget.value)}
              onKeyDown={({ key }) => key === "Enter" && answer()}
            />
            <button class="button" onClick={answer}>
              Answer
            </button>
          </>
        )}
      </div>
    </section>
  );
}

function Jogging({ now, send }: Props) {
  const isAxis = now.frame === "axis";
  const { position: p, orientation: q } = now.pose;
  const turn = rotationOf(q.w, q.x, q.y, q.z);
  const values = isAxis
    ? [...now.joints].map((angle) => `${(angle / DEGREE).toFixed(2)}°`)
    : [...[p.x, p.y, p.z].map((way) => `${(1e3 * way).toFixed(2)} mm`), ...turn.map((a) => `${a.toFixed(2)}°`)];
  const isEnabled = now.mode === "manual" && (now.state === "idle" || now.state === "stopped" || now.state === "error");
  const increment = INCREMENTS[[1, 5, 20].indexOf(now.step)] ?? "medium";
  return (
    <section>
      <h4>Jog</h4>
      <div class="rapid-pendant-row">
        <Choice name="frame" options={FRAMES} value={now.frame} send={send} />
        <Choice name="increment" options={INCREMENTS} value={increment} send={send} />
        <Choice name="tool" options={now.tools} value={now.tool} send={send} />
        <Choice name="wobj" options={now.wobjs} value={now.wobj} send={send} />
      </div>
      <table class="figures">
        <tbody>
          {Array.from(values, (value, i) => (
            <tr key={i}>
              <td>{isAxis ? `axis ${i + 1}` : WAYS[i]}</td>
              <td>
                <Command command={`jog ${i + 1} -`} text="−" isEnabled={isEnabled} send={send} />
              </td>
              <td data-test={`value-${i + 1}`}>{value}</td>
              <td>
                <Command command={`jog ${i + 1} +`} text="+" isEnabled={isEnabled} send={send} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

function Positions({ now, send }: Props) {
  const isEnabled = now.state === "idle" || now.state === "stopped" || now.state === "error";
  return now.positions.length > 0 ? (
    <section>
      <h4>Positions</h4>
      <div class="rapid-pendant-row">
        {now.positions.map((name) => (
          <Command key={name} command={`modpos ${name}`} text={`ModPos ${name}`} isEnabled={isEnabled} send={send} />
        ))}
        <Command command="save" text="Save" isEnabled={now.is_modified} send={send} />
      </div>
    </section>
  ) : null;
}

function Signals({ now, send }: Props) {
  return now.signals.length > 0 ? (
    <section>
      <h4>Signals</h4>
      <table class="figures">
        <tbody>
          {now.signals.map((name, i) => {
            const value = now.values[i] ?? 0;
            const next = value === 0 ? 1 : 0;
            return (
              <tr key={name}>
                <td>{name}</td>
                <td>
                  <Command command={`signal ${name} ${next}`} text={String(value)} isEnabled send={send} />
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </section>
  ) : null;
}

function Command({
  command,
  text,
  isEnabled,
  send,
}: {
  command: string;
  text: string;
  isEnabled: boolean;
  send: Send;
}) {
  return (
    <button class="button" data-command={command} disabled={!isEnabled} onClick={() => send(command)}>
      {text}
    </button>
  );
}

function Choice(props: { name: string; options: readonly string[]; value: string; send: Send }) {
  const { name, options, value, send } = props;
  return (
    <select
      aria-label={name}
      data-choice={name}
      value={value}
      onChange={({ currentTarget }) => send(`${name} ${currentTarget.value}`)}
    >
      {options.map((option) => (
        <option key={option} value={option}>
          {option}
        </option>
      ))}
    </select>
  );
}

/** The angles about x, then y, then z of the base [deg] of a quaternion. */
function rotationOf(w: number, x: number, y: number, z: number): number[] {
  const pitch = Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x))));
  return [
    Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) / DEGREE,
    pitch / DEGREE,
    Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) / DEGREE,
  ];
}

export default {
  id: "rapid_pendant",
  title: "RAPID pendant",
  icon: "robot",
  mount: withPreact(RapidPendantPanel),
} satisfies BuiltInPanel;
