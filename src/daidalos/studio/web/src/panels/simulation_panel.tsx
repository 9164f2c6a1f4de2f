// Simulation: the simulated world, its editor, and the controls of its time.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { Studio } from "../app/studio";
import { attachEditor } from "../app/test_hooks";
import { theme } from "../app/theme";
import { Choice, NumberField } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon, type IconName } from "../ui/icons";
import { Menu, MenuItem, MenuSeparator } from "../ui/menu";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/simulation.css";

import { describePose, Editor, type Mode, type Shape } from "./simulation/editor";
import { resourceAt, SIMULATOR_TYPE, Simulator, type Resource } from "./simulation/simulator";
import { openRoom, type Room as Tools } from "./simulation/room";
import { Stage } from "./simulation/stage";

const SPEEDS: readonly (readonly [string, string])[] = [
  ["0.1", "0.1 ×"],
  ["0.25", "¼ ×"],
  ["0.5", "½ ×"],
  ["1", "1 ×"],
  ["2", "2 ×"],
  ["5", "5 ×"],
  ["10", "10 ×"],
  ["0", "as fast as possible"],
];
const STEPS: readonly (readonly [string, string])[] = ["1", "10", "100", "1000"].map(
  (count) => [count, count === "1" ? "1 step" : `${count} steps`] as const,
);
const MODES: readonly (readonly [Mode, IconName, string])[] = [
  ["look", "select", "Select (Esc)"],
  ["move", "move", "Move (t)"],
  ["turn", "turn", "Rotate (r)"],
  ["scale", "scale", "Scale (s)"],
];
const SHAPES: readonly (readonly [Shape, IconName])[] = [
  ["box", "cube"],
  ["sphere", "sphere"],
  ["cylinder", "cylinder"],
];
const HINTS: Record<Mode, string> = {
  look: "Click: select · Double click: centre the view · Left: rotate · Middle: move · Wheel: zoom",
  move: "Drag an arrow, or the model along the ground (Shift: up and down) · Ctrl: in steps of 0.25 m · Esc: cancel",
  turn: "Drag a ring, or the model sideways · Ctrl: in steps of 15° · Esc: cancel",
  scale: "Drag a handle, or the model up and down · Ctrl: in steps of a quarter · Esc: cancel",
  insert: "Click to insert · Shift: insert another one · Esc: cancel",
};

function SimulationPanel({ studio, visible }: PanelProps) {
  const service = studio.session.services.value.find(({ type }) => type === SIMULATOR_TYPE)?.name;
  if (service === undefined) {
    return (
      <Empty icon="cube" title="No simulator is running">
        <code>ros2 launch gazebo_ros gazebo.launch.py</code>
      </Empty>
    );
  }
  const name = service.replace(/\/[^/]*$/, "");
  return <Room key={name} studio={studio} name={name} isVisible={visible.value} />;
}

function Room({ studio, name, isVisible }: { studio: Studio; name: string; isVisible: boolean }) {
  const container = useRef<HTMLDivElement>(null);
  const tools = useSignal<Tools | undefined>(undefined);
  const failure = useSignal("");
  useEffect(() => {
    if (!isVisible) {
      return undefined;
    }
    try {
      const [made, dispose] = open(studio, name, container.current as HTMLDivElement);
      openRoom.value = tools.value = made;
      return () => {
        tools.value = undefined;
        openRoom.value = openRoom.peek() === made ? undefined : openRoom.peek();
        dispose();
      };
    } catch (error) {
      failure.value = error instanceof Error ? error.message : String(error);
      return undefined;
    }
  }, [isVisible]);
  return (
    <div class="column">
      {tools.value && <TimeBar tools={tools.value} />}
      <div class="scene simulation">
        <div class="scene-canvas" ref={container} data-test="simulation" />
        {tools.value && <EditBar tools={tools.value} />}
        {tools.value && (
          <div class={`hint ${tools.value.editor.mode.value === "look" ? "" : "busy"}`}>
            {HINTS[tools.value.editor.mode.value]}
          </div>
        )}
        {failure.value && <Empty icon="cube" title="This browser does not support WebGL 2" />}
      </div>
      {tools.value && <Foot tools={tools.value} />}
    </div>
  );
}

function open(studio: Studio, name: string, container: HTMLDivElement): [Tools, () => void] {
  const { session, tf, assets } = studio;
  const stage = new Stage(container, { session, tf, assets, theme: () => theme.value });
  const simulator = new Simulator(session, name);
  const editor = new Editor(container, stage, simulator);
  const detach = attachEditor(editor);
  let isLooking = false;
  const look = async () => {
    if (!isLooking) {
      isLooking = true;
      // Without an answer while the connection is lost or a world is replaced: the next call is made a second later.
      await simulator.look().then(
        (looks) => stage.show(looks),
        () => undefined,
      );
      isLooking = false;
    }
  };
  void look();
  const observer = new ResizeObserver(() => stage.viewport.resize(container.clientWidth, container.clientHeight));
  observer.observe(container);
  const stops = [
    () => observer.disconnect(),
    simulator.follow(
      (states) => {
        if (!stage.place(states)) {
          void look();
        }
      },
      () => {
        if (simulator.isPlaying.value === false) {
          void look();
        }
      },
    ),
    studio.onFrame((page) => {
      editor.follow();
      stage.draw(page);
    }),
    detach,
    () => editor.dispose(),
    () => stage.dispose(),
  ];
  return [{ simulator, stage, editor }, () => stops.forEach((stop) => stop())];
}

function TimeBar({ tools: { simulator, editor } }: { tools: Tools }) {
  const steps = useSignal("10");
  const isPlaying = simulator.isPlaying.value;
  return (
    <div class="bar wrap">
      <button
        class="button primary"
        title={isPlaying ? "Pause the simulation" : "Resume the simulation"}
        data-test="play"
        disabled={isPlaying === undefined}
        onClick={() => void editor.run(() => simulator.play(!isPlaying))}
      >
        <Icon name={isPlaying ? "pause" : "play"} /> {isPlaying ? "Pause" : "Play"}
      </button>
      <button
        class="button"
        title="Step the paused simulation"
        data-test="step"
        disabled={isPlaying !== false}
        onClick={() => void editor.run(() => simulator.step(Number(steps.value)))}
      >
        <Icon name="step" /> Step
      </button>
      <Choice label="Steps per click" value={steps.value} options={STEPS} onChange={(count) => (steps.value = count)} />
      <Choice
        label="Speed"
        value={String(simulator.speed ?? "1")}
        options={SPEEDS}
        onChange={(speed) => simulator.setSpeed(Number(speed))}
      />
      <button
        class="button"
        title="Reset time and the states of models"
        data-test="reset"
        onClick={() => void editor.run(() => simulator.reset())}
      >
        <Icon name="reset" /> Reset
      </button>
    </div>
  );
}

function EditBar({ tools: { simulator, editor, stage } }: { tools: Tools }) {
  const mode = editor.mode.value;
  const template = editor.template.value;
  const file = useRef<HTMLInputElement>(null);
  const readFile = async (given: File | undefined) => {
    if (given) {
      editor.setMode("insert", { title: given.name, uri: "", resource_string: await given.text() });
    }
  };
  return (
    <div class="overlay-bar tools wrap" role="toolbar" aria-label="Edit the world">
      {MODES.map(([each, icon, title]) => (
        <button
          key={each}
          class={`tool ${mode === each ? "active" : ""}`}
          title={title}
          aria-pressed={mode === each}
          data-test={`mode-${each}`}
          onClick={() => editor.setMode(each)}
        >
          <Icon name={icon} />
        </button>
      ))}
      <span class="tool-gap" />
      {SHAPES.map(([shape, icon]) => (
        <button
          key={shape}
          class={`tool ${mode === "insert" && template === shape ? "active" : ""}`}
          title={`Insert a ${shape}`}
          data-test={`insert-${shape}`}
          onClick={() => editor.setMode("insert", shape)}
        >
          <Icon name={icon} />
        </button>
      ))}
      <Menu
        test="models-to-insert"
        label="Model"
        icon="add"
        align="left"
        class="tool"
        onOpen={() => void simulator.readSpawnables()}
      >
        {simulator.spawnables.value.map((model: Resource) => (
          <MenuItem
            key={model.uri}
            icon="cube"
            note={model.origin ?? ""}
            onChoose={() => editor.setMode("insert", model)}
          >
            {model.title}
          </MenuItem>
        ))}
        <MenuSeparator />
        <MenuItem icon="add" onChoose={() => file.current?.click()}>
          From a file (SDF or URDF) …
        </MenuItem>
        <AddressField onChoose={(uri) => editor.setMode("insert", resourceAt(uri))} />
      </Menu>
      <input
        ref={file}
        type="file"
        accept=".sdf,.urdf,.xml"
        hidden
        data-test="model-file"
        onChange={(event) => void readFile(event.currentTarget.files?.[0])}
      />
      {mode === "insert" && typeof template === "string" && (
        <>
          <NumberField
            label="Size"
            value={editor.size.value}
            min={0.02}
            max={20}
            step={0.05}
            unit="m"
            onChange={(size) => (editor.size.value = size)}
          />
          <NumberField
            label="Mass; 0: static"
            value={editor.mass.value}
            min={0}
            max={10000}
            step={0.5}
            unit="kg"
            onChange={(mass) => (editor.mass.value = mass)}
          />
        </>
      )}
      {mode === "insert" && typeof template !== "string" && <span class="faint tool-words">{template.title}</span>}
      <span class="tool-gap" />
      <button
        class="tool"
        title={editor.undoStack.next.value ? `Undo: ${editor.undoStack.next.value} (Ctrl+Z)` : "Nothing to undo"}
        data-test="undo"
        disabled={!editor.undoStack.next.value}
        onClick={() => editor.undo()}
      >
        <Icon name="undo" />
      </button>
      <button
        class="tool"
        title="Delete the selected model (Delete)"
        data-test="delete"
        disabled={!stage.selected.value}
        onClick={() => void editor.remove()}
      >
        <Icon name="trash" />
      </button>
    </div>
  );
}

/** For models that are not listed: a URI that the simulator resolves. */
function AddressField({ onChoose }: { onChoose(uri: string): void }) {
  return (
    <div class="menu-field">
      <input
        class="field grow mono"
        type="text"
        aria-label="Address of a model"
        placeholder="model://name"
        title="model://…, package://…, or a path where the simulator runs"
        spellcheck={false}
        data-test="model-address"
        onClick={(event) => event.stopPropagation()}
        onKeyDown={(event) => {
          const uri = event.currentTarget.value.trim();
          if (event.key === "Enter" && uri) {
            onChoose(uri);
            event.currentTarget.parentElement?.click();
          }
        }}
      />
    </div>
  );
}

function Foot({ tools: { stage, editor } }: { tools: Tools }) {
  return (
    <footer class="bar faint">
      <Choice
        label="Selected model"
        value={stage.selected.value}
        options={[["", "nothing selected"], ...stage.names.value.map((name) => [name, name] as const)]}
        onChange={(name) => stage.select(name)}
      />
      <span class="figures" data-test="models">
        {stage.names.value.length} {stage.names.value.length === 1 ? "model" : "models"}
      </span>
      {stage.reading.value && (
        <span class="figures ellipsis pose" data-test="pose" title="Pose of the selected model in the world frame">
          {describePose(stage.reading.value)}
        </span>
      )}
      <span class="stretch" />
      {editor.error.value && (
        <span class="error-text ellipsis" role="alert" title={editor.error.value}>
          {editor.error.value}
        </span>
      )}
    </footer>
  );
}

export default {
  id: "simulation",
  title: "Simulation",
  icon: "play",
  mount: withPreact(SimulationPanel),
} satisfies BuiltInPanel;
