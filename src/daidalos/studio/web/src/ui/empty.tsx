// The text of a panel that has nothing to show.
import type { ComponentChildren } from "preact";
import { Icon, type IconName } from "./icons";

export function Empty({ icon, title, children }: { icon: IconName; title: string; children?: ComponentChildren }) {
  return (
    <div class="empty">
      <Icon name={icon} size={28} />
      <strong>{title}</strong>
      {children && <span>{children}</span>}
    </div>
  );
}
