// A button that opens a list to choose from.
import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { Icon, type IconName } from "./icons";

interface MenuProps {
  label: string;
  icon?: IconName;
  /** Class of the button. */
  class?: string;
  /** At which edge of the button the list hangs. */
  align?: "left" | "right";
  onOpen?(): void;
  /** The button's `data-test`. */
  test?: string;
  children: ComponentChildren;
}

export function Menu({ label, icon, align = "right", children, onOpen, ...rest }: MenuProps) {
  const [open, setOpen] = useState(false);
  const root = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    if (!open) {
      return undefined;
    }
    onOpen?.();
    const closeOutside = (event: PointerEvent) => {
      if (!root.current?.contains(event.target as Node)) {
        setOpen(false);
      }
    };
    const closeByKey = (event: KeyboardEvent) => {
      if (event.key === "Escape") {
        setOpen(false);
      }
    };
    document.addEventListener("pointerdown", closeOutside, true);
    document.addEventListener("keydown", closeByKey);
    return () => {
      document.removeEventListener("pointerdown", closeOutside, true);
      document.removeEventListener("keydown", closeByKey);
    };
  }, [open]);
  return (
    <span class="menu" ref={root}>
      <button
        class={`button ${rest.class ?? ""}`}
        data-test={rest.test}
        aria-haspopup="menu"
        aria-label={label}
        aria-expanded={open}
        onClick={() => setOpen(!open)}
      >
        {icon && <Icon name={icon} />}
        <span class="menu-label">{label}</span>
      </button>
      {open && (
        <div class={`menu-list ${align}`} role="menu" onClick={() => setOpen(false)}>
          {children}
        </div>
      )}
    </span>
  );
}

interface ItemProps {
  icon?: IconName;
  onChoose(): void;
  /** Shown in a fainter colour at the end of the line. */
  note?: string;
  children: ComponentChildren;
}

export function MenuItem({ icon, onChoose, note, children }: ItemProps) {
  return (
    <button class="menu-item" role="menuitem" onClick={onChoose}>
      {icon && <Icon name={icon} />}
      <span class="ellipsis">{children}</span>
      {note && <span class="faint note">{note}</span>}
    </button>
  );
}

export function MenuSeparator() {
  return <div class="menu-separator" role="separator" />;
}
