// The help: keyboard and mouse.
import { TOOLS } from "../tools/registry";
import { Dialog } from "../ui/dialog";
import { helpIsOpen } from "./help_state";

const VIEW_KEYS = [
  ["t", "Top-down view or orbit"],
  ["l", "Follow the robot"],
  ["z", "Home view"],
  ["d", "Dark or light theme"],
  ["Esc", "Deselect the tool"],
  ["?", "This help"],
] as const;

const TAB_KEYS = [
  ["← →", "Another tab"],
  ["Home  End", "First or last tab"],
  ["Del", "Close the panel"],
] as const;

const SIMULATION_KEYS = [
  ["t  r  s", "Move, rotate, scale a model"],
  ["Ctrl", "Snap while dragging"],
  ["Del", "Delete the selected model"],
  ["Ctrl+Z", "Undo"],
] as const;

const PLOT_MOUSE = [
  ["Drag", "Zoom to a box"],
  ["Wheel", "Zoom time (Shift: values)"],
  ["Shift + drag", "Move"],
  ["Double click", "Reset zoom and resume"],
] as const;

const MOUSE = [
  ["Left", "Rotate"],
  ["Middle", "Move (also Shift + left)"],
  ["Wheel", "Zoom (also right)"],
] as const;

export function Help() {
  if (!helpIsOpen.value) {
    return null;
  }
  return (
    <Dialog title="Keyboard and mouse" onClose={() => (helpIsOpen.value = false)}>
      <div class="columns">
        <Keys title="Tools" rows={TOOLS.map(({ key, title }) => [key, title] as const)} />
        <Keys title="View" rows={VIEW_KEYS} />
        <Keys title="Mouse" rows={MOUSE} />
        <Keys title="Tabs" rows={TAB_KEYS} />
        <Keys title="Simulation" rows={SIMULATION_KEYS} />
        <Keys title="Plot" rows={PLOT_MOUSE} />
      </div>
    </Dialog>
  );
}

function Keys({ title, rows }: { title: string; rows: readonly (readonly [key: string, meaning: string])[] }) {
  return (
    <section>
      <h3>{title}</h3>
      <dl>
        {rows.map(([key, meaning]) => (
          <div key={key}>
            <dt>
              <kbd>{key}</kbd>
            </dt>
            <dd>{meaning}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
