// How finely to draw: begun by what the machine seems to be, then measured.
import { beginsFine, staysFine } from "./graphics";

const FAST_S = 1 / 50;
/** Drawn frames in a row that must be late or early before the quality changes. */
const LATE_FRAMES = 20;
const EARLY_FRAMES = 600;
/** In software every frame takes the processor from the robot's programs: fewer must do. */
const LEVELS = [
  { share: 1, shadows: "soft", period: 1 / 30, late: 1 / 22 },
  { share: 1, shadows: "flat", period: 1 / 24, late: 1 / 12 },
  { share: 1, shadows: "none", period: 1 / 24, late: 1 / 12 },
  { share: 0.75, shadows: "none", period: 1 / 20, late: 1 / 11 },
  { share: 0.75, shadows: "none", period: 1 / 12, late: Infinity },
] as const;
const SHARPEST = 2;

/** Soft ones fall on everything, flat ones on the ground alone, with hard edges. */
export type Shadows = "soft" | "flat" | "none";

export class Quality {
  private level = beginsFine ? 0 : 1;
  private late = 0;
  private early = 0;
  private drawnAt = 0;
  /** Going back and forth would flicker: what was too slow once is not tried a second time. */
  private mayRise = true;

  get shadows(): Shadows {
    return this.step.shadows;
  }

  get pixelRatio(): number {
    const best = beginsFine ? Math.min(SHARPEST, window.devicePixelRatio) : 1;
    return best * this.step.share;
  }

  /** Whether it is time for another frame. */
  isDue(page: number): boolean {
    // Screens are not exact: a frame that is due a moment later is due now.
    const period = beginsFine ? 1 / 60 : this.step.period;
    return page - this.drawnAt > period - 0.004;
  }

  /** Take note of a drawn frame; return whether the quality has changed. */
  judge(page: number): boolean {
    const span = page - this.drawnAt;
    this.drawnAt = page;
    if (span > 0.5 || staysFine) {
      return false; // nothing moved for a while, or nothing is to change
    }
    this.late = span > this.step.late ? this.late + 1 : 0;
    this.early = span < FAST_S ? this.early + 1 : 0;
    if (this.late > LATE_FRAMES && this.level < LEVELS.length - 1) {
      this.level++;
    } else if (this.early > EARLY_FRAMES && this.level > 0 && beginsFine && this.mayRise) {
      this.level--;
      this.mayRise = false;
    } else {
      return false;
    }
    this.late = this.early = 0;
    return true;
  }

  private get step(): (typeof LEVELS)[number] {
    return LEVELS[this.level] ?? LEVELS[0];
  }
}
