// Whether the help is open.
import { signal } from "@preact/signals";

export const helpIsOpen = signal(false);
