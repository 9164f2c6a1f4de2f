// What draws: a graphics card, or the processor in its place, which must be asked for less.

const asked = new URLSearchParams(globalThis.location?.search ?? "").get("quality");

/** Whether to draw as finely as possible at any cost: ?quality=best in the page's address, for pictures. */
export const staysFine = asked === "best";

/** Whether to start with high quality; ?quality=fast turns it off. */
export const beginsFine = staysFine || (asked !== "fast" && !drawsInSoftware());

function drawsInSoftware(): boolean {
  const gl = globalThis.document?.createElement("canvas").getContext("webgl2");
  if (!gl) {
    return false;
  }
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
