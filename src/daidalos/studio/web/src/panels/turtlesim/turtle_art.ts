// Drawings of turtles, seen from above, in lines and colours of our own.

interface Palette {
  light: string;
  shell: string;
  line: string;
  skin: string;
  shade: string;
}

const PALETTES: readonly Palette[] = [
  { light: "#b4e07c", shell: "#4a9a4c", line: "#245c35", skin: "#c4e388", shade: "#7daa4c" },
  { light: "#ffd98a", shell: "#cf7f30", line: "#84461a", skin: "#f6e3a6", shade: "#c7a25a" },
  { light: "#98efdf", shell: "#23999c", line: "#0f5c66", skin: "#c8f4d9", shade: "#72bd9f" },
  { light: "#ffc2ae", shell: "#dd5f55", line: "#8f2f33", skin: "#ffe6cb", shade: "#dba784" },
  { light: "#dcc6ff", shell: "#875cd0", line: "#4b2d86", skin: "#ebdfff", shade: "#ac92d9" },
  { light: "#ffd0e6", shell: "#d6659f", line: "#8b3163", skin: "#ffe8f0", shade: "#dba3ba" },
  { light: "#e2e9f2", shell: "#7387a1", line: "#3f4d63", skin: "#e9eedc", shade: "#a8b391" },
  { light: "#f6f7a2", shell: "#b0bb33", line: "#666f15", skin: "#e3f0c9", shade: "#9cb77a" },
];

type Pattern = (context: CanvasRenderingContext2D, palette: Palette) => void;

const PATTERNS: readonly Pattern[] = [drawScutes, drawRidges, drawSpiral, drawFlower];

/** How many pixels of turtlesim's window a unit of these drawings is: half a shell. */
export const HALF_SHELL = 14.5;

/**
 * Draw a turtle that looks along x; a unit is half the length of its shell.
 *
 * `left` and `right` are the angles of the front flippers, in radians from rest, positive to the front.
 */
export function drawTurtle(
  context: CanvasRenderingContext2D,
  kind: number,
  { left, right }: { left: number; right: number },
): void {
  const palette = PALETTES[kind % PALETTES.length] as Palette;
  const pattern = PATTERNS[kind % PATTERNS.length] as Pattern;
  context.lineJoin = context.lineCap = "round";
  drawLimbs(context, palette, -1, left);
  drawLimbs(context, palette, 1, right);
  drawTail(context, palette);
  drawHead(context, palette);
  drawShell(context, palette, pattern);
}

/** The shadow of a turtle: soft, and the same for all. */
export function drawShadow(context: CanvasRenderingContext2D): void {
  const shade = context.createRadialGradient(0, 0, 0.2, 0, 0, 1.75);
  shade.addColorStop(0, "#02081a8c");
  shade.addColorStop(0.55, "#02081a4d");
  shade.addColorStop(1, "#02081a00");
  context.fillStyle = shade;
  context.beginPath();
  context.ellipse(0, 0, 1.8, 1.55, 0, 0, 2 * Math.PI);
  context.fill();
}

function drawLimbs(context: CanvasRenderingContext2D, palette: Palette, side: number, swing: number): void {
  context.save();
  context.scale(1, side);
  limb(context, palette, () => {
    context.moveTo(-0.55, 0.55);
    context.bezierCurveTo(-0.7, 1.0, -1.1, 1.22, -1.42, 1.12);
    context.bezierCurveTo(-1.38, 0.86, -1.2, 0.55, -0.88, 0.32);
  });
  context.translate(0.5, 0.5);
  context.rotate(-swing);
  limb(context, palette, () => {
    context.moveTo(0.3, -0.12);
    context.bezierCurveTo(0.62, 0.42, 0.5, 1.12, -0.22, 1.42);
    context.bezierCurveTo(-0.52, 1.5, -0.6, 1.3, -0.42, 1.16);
    context.bezierCurveTo(-0.14, 0.9, -0.2, 0.5, -0.3, 0.2);
  });
  context.restore();
}

function limb(context: CanvasRenderingContext2D, palette: Palette, outline: () => void): void {
  context.beginPath();
  outline();
  context.closePath();
  const skin = context.createRadialGradient(0, 0.1, 0.1, 0, 0.3, 1.5);
  skin.addColorStop(0, palette.shade);
  skin.addColorStop(0.6, palette.skin);
  skin.addColorStop(1, palette.shade);
  context.fillStyle = skin;
  context.fill();
  context.strokeStyle = palette.line;
  context.lineWidth = 0.06;
  context.stroke();
}

function drawTail(context: CanvasRenderingContext2D, palette: Palette): void {
  context.beginPath();
  context.moveTo(-0.95, -0.14);
  context.quadraticCurveTo(-1.3, -0.08, -1.46, 0);
  context.quadraticCurveTo(-1.3, 0.08, -0.95, 0.14);
  context.fillStyle = palette.shade;
  context.fill();
  context.strokeStyle = palette.line;
  context.lineWidth = 0.06;
  context.stroke();
}

function drawHead(context: CanvasRenderingContext2D, palette: Palette): void {
  context.beginPath();
  context.moveTo(0.75, -0.26);
  context.bezierCurveTo(1.0, -0.28, 1.02, -0.4, 1.3, -0.39);
  context.bezierCurveTo(1.62, -0.37, 1.8, -0.16, 1.8, 0);
  context.bezierCurveTo(1.8, 0.16, 1.62, 0.37, 1.3, 0.39);
  context.bezierCurveTo(1.02, 0.4, 1.0, 0.28, 0.75, 0.26);
  context.closePath();
  const skin = context.createRadialGradient(1.35, -0.08, 0.05, 1.3, 0, 0.62);
  skin.addColorStop(0, palette.skin);
  skin.addColorStop(1, palette.shade);
  context.fillStyle = skin;
  context.fill();
  context.strokeStyle = palette.line;
  context.lineWidth = 0.06;
  context.stroke();
  for (const side of [-1, 1]) {
    disc(context, 1.46, 0.235 * side, 0.115, "#fdfdf8");
    disc(context, 1.485, 0.245 * side, 0.078, "#141a22");
    disc(context, 1.51, 0.222 * side, 0.026, "#ffffff");
    disc(context, 1.7, 0.06 * side, 0.022, palette.line);
  }
}

function disc(context: CanvasRenderingContext2D, x: number, y: number, radius: number, color: string): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
}

function drawShell(context: CanvasRenderingContext2D, palette: Palette, pattern: Pattern): void {
  shellOutline(context, 1);
  context.fillStyle = palette.shell;
  context.fill();
  context.strokeStyle = palette.line;
  context.lineWidth = 0.08;
  context.stroke();
  drawRim(context, palette);
  context.save();
  shellOutline(context, 0.83);
  const dome = context.createRadialGradient(0.22, -0.2, 0.05, 0, 0, 1.05);
  dome.addColorStop(0, palette.light);
  dome.addColorStop(1, palette.shell);
  context.fillStyle = dome;
  context.fill();
  context.clip();
  pattern(context, palette);
  const gleam = context.createRadialGradient(0.3, -0.3, 0, 0.3, -0.3, 0.6);
  gleam.addColorStop(0, "#ffffff73");
  gleam.addColorStop(1, "#ffffff00");
  context.fillStyle = gleam;
  context.fillRect(-1.2, -1.2, 2.4, 2.4);
  context.restore();
  shellOutline(context, 0.83);
  context.strokeStyle = palette.line;
  context.lineWidth = 0.05;
  context.stroke();
}

/** Broad at the shoulders, pointed at the tail. */
function shellOutline(context: CanvasRenderingContext2D, size: number): void {
  context.beginPath();
  context.moveTo(size, 0);
  context.bezierCurveTo(size, 0.56 * size, 0.58 * size, 0.9 * size, 0.02 * size, 0.88 * size);
  context.bezierCurveTo(-0.56 * size, 0.86 * size, -0.94 * size, 0.44 * size, -1.1 * size, 0);
  context.bezierCurveTo(-0.94 * size, -0.44 * size, -0.56 * size, -0.86 * size, 0.02 * size, -0.88 * size);
  context.bezierCurveTo(0.58 * size, -0.9 * size, size, -0.56 * size, size, 0);
  context.closePath();
}

/** The small plates at the edge. */
function drawRim(context: CanvasRenderingContext2D, palette: Palette): void {
  context.save();
  shellOutline(context, 1);
  context.clip();
  context.beginPath();
  for (let plate = 0; plate < 22; plate++) {
    const angle = ((plate + 0.5) / 22) * 2 * Math.PI;
    context.moveTo(0.6 * Math.cos(angle), 0.5 * Math.sin(angle));
    context.lineTo(1.3 * Math.cos(angle), 1.1 * Math.sin(angle));
  }
  context.strokeStyle = palette.line;
  context.globalAlpha = 0.55;
  context.lineWidth = 0.045;
  context.stroke();
  context.restore();
}

/** A row of five plates along the back, and plates beside them. */
function drawScutes(context: CanvasRenderingContext2D, palette: Palette): void {
  const joints = [0.95, 0.56, 0.2, -0.18, -0.54, -0.95];
  const [narrow, wide] = [0.17, 0.31];
  context.beginPath();
  for (let i = 0; i + 1 < joints.length; i++) {
    const [front, back] = [joints[i] as number, joints[i + 1] as number];
    const middle = (front + back) / 2;
    const widest = i === 0 || i === 4 ? 0.22 : wide;
    context.moveTo(front, -narrow);
    for (const [x, y] of [
      [middle, -widest],
      [back, -narrow],
      [back, narrow],
      [middle, widest],
      [front, narrow],
    ] as const) {
      context.lineTo(x, y);
    }
    context.closePath();
  }
  context.fillStyle = palette.light;
  context.globalAlpha = 0.45;
  context.fill();
  context.globalAlpha = 1;
  for (const side of [-1, 1]) {
    for (const [x, far] of [
      [0.38, 0.62],
      [0.01, 0.02],
      [-0.36, -0.55],
      [-0.72, -0.9],
    ] as const) {
      context.moveTo(x, side * (x === -0.72 ? 0.22 : wide));
      context.lineTo(far, side * 0.95);
    }
  }
  stroke(context, palette, 0.055);
}

/** Keels from front to back, as a leatherback has them. */
function drawRidges(context: CanvasRenderingContext2D, palette: Palette): void {
  context.beginPath();
  for (const bow of [-0.78, -0.52, -0.26, 0, 0.26, 0.52, 0.78]) {
    context.moveTo(0.9, 0.35 * bow);
    context.bezierCurveTo(0.45, 1.1 * bow, -0.3, 1.25 * bow, -0.95, 0);
  }
  stroke(context, palette, 0.06);
  context.beginPath();
  for (const bow of [-0.39, 0, 0.39]) {
    for (let share = 0.14; share < 0.86; share += 0.13) {
      const x = 0.9 - 1.85 * share;
      const y = 3.3 * bow * share * (1 - share);
      context.moveTo(x + 0.04, y);
      context.arc(x, y, 0.04, 0, 2 * Math.PI);
    }
  }
  context.fillStyle = palette.light;
  context.fill();
}

/** A snail's line that winds out from the middle. */
function drawSpiral(context: CanvasRenderingContext2D, palette: Palette): void {
  context.beginPath();
  context.moveTo(0, 0);
  for (let angle = 0; angle < 7.5 * Math.PI; angle += 0.12) {
    const radius = 0.043 * angle;
    context.lineTo(radius * Math.cos(angle), 0.88 * radius * Math.sin(angle));
  }
  stroke(context, palette, 0.075);
}

/** Petals around the middle. */
function drawFlower(context: CanvasRenderingContext2D, palette: Palette): void {
  for (const [count, inner, outer, breadth] of [
    [10, 0.3, 0.86, 0.13],
    [6, 0.06, 0.52, 0.14],
  ] as const) {
    for (let petal = 0; petal < count; petal++) {
      context.save();
      context.rotate(((petal + 0.5 * (count % 4)) / count) * 2 * Math.PI);
      context.beginPath();
      context.ellipse((inner + outer) / 2, 0, (outer - inner) / 2, breadth, 0, 0, 2 * Math.PI);
      context.fillStyle = palette.light;
      context.globalAlpha = 0.55;
      context.fill();
      context.globalAlpha = 1;
      stroke(context, palette, 0.045);
      context.restore();
    }
  }
  disc(context, 0, 0, 0.12, palette.line);
  disc(context, 0, 0, 0.075, palette.light);
}

function stroke(context: CanvasRenderingContext2D, palette: Palette, width: number): void {
  context.strokeStyle = palette.line;
  context.lineWidth = width;
  context.globalAlpha = 0.8;
  context.stroke();
  context.globalAlpha = 1;
}
