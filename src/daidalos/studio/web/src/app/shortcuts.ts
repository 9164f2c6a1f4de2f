// Keys: RViz's for the tools, and a few for the views.
import { followed, type World } from "../scene/world";
import { helpIsOpen } from "./help_state";
import { toggleTheme } from "./theme";

export function listenToKeys(world: () => World | undefined): void {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) {
      return;
    }
    if (act(event.key, world())) {
      event.preventDefault();
    }
  });
}

function act(key: string, world: World | undefined): boolean {
  switch (key) {
    case "?":
      helpIsOpen.value = !helpIsOpen.value;
      return true;
    case "d":
      toggleTheme();
      return true;
  }
  if (key === "Escape" && helpIsOpen.value) {
    helpIsOpen.value = false;
    return true;
  }
  if (!world) {
    return false;
  }
  switch (key) {
    case "t":
      world.switchView(world.viewKind.value === "top" ? "orbit" : "top");
      return true;
    case "z":
      world.home();
      return true;
    case "l":
      world.follow(followed.value ? "" : (world.robotFrame() ?? ""));
      return true;
  }
  return world.toolbox.selectByKey(key);
}

function isTyping(target: EventTarget | null): boolean {
  return (
    target instanceof HTMLElement && target.matches("input:not([type=checkbox]), textarea, select, [contenteditable]")
  );
}
