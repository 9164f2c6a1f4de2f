// What displays of installed packages are made with.
import type { DisplayKit } from "../contract";
import * as three from "./kit_three";
import { StampedDisplay } from "./topic_display";

export const KIT: DisplayKit = {
  three,
  // Of the page's class the contract has only what others may use.
  StampedDisplay: StampedDisplay as unknown as DisplayKit["StampedDisplay"],
};
