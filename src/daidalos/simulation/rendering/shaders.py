"""GLSL 3.30 shaders of `gl_renderer`.

They follow the software renderer: the same light, shadow and textures by the same formulas. What differs from part to
part lies in a texture with a row for each: three texels of pose, colour, glow with what is wanted, and the texture.
"""

PARTS = 6
"""Texels of a part."""

LIGHT_TEXELS = 5
"""Texels of a light: the numbers of `lights.LIGHT_SIZE`, filled up."""

ATLAS_WIDTH = 4096

VERTEX = """
#version 330
uniform sampler2D parts;
uniform mat4 projection;
uniform float wanted;
in vec3 place;
in vec3 normal;
in vec2 uv;
in float part;
out vec3 seen_place;
out vec3 seen_normal;
out vec2 seen_uv;
flat out int seen_part;
void main() {
    int row = int(part);
    mat3x4 pose = mat3x4(texelFetch(parts, ivec2(0, row), 0), texelFetch(parts, ivec2(1, row), 0),
                         texelFetch(parts, ivec2(2, row), 0));
    seen_place = vec4(place, 1.0) * pose;
    seen_normal = vec4(normal, 0.0) * pose;
    seen_uv = uv;
    seen_part = row;
    bool drawn = texelFetch(parts, ivec2(4, row), 0).a == wanted;
    gl_Position = drawn ? projection * vec4(seen_place, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
"""

_FACING = """
#version 330
uniform sampler2D parts;
in vec3 seen_place;
in vec3 seen_normal;
in vec2 seen_uv;
flat in int seen_part;
bool hidden() {
    return !gl_FrontFacing && texelFetch(parts, ivec2(5, seen_part), 0).z == 0.0;
}
"""

DEPTH = (
    _FACING
    + """
out vec2 found;
void main() {
    if (hidden()) discard;
    found = vec2(1.0 / seen_place.z, float(gl_PrimitiveID));
}
"""
)

SKY_VERTEX = """
#version 330
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
"""

SKY = """
#version 330
uniform vec4 lens;
uniform vec3 horizon;
uniform vec3 low;
uniform vec3 high;
out vec4 color;
void main() {
    vec3 ray = vec3((gl_FragCoord.xy - 0.5 - lens.zw) / lens.xy, 1.0);
    float up = dot(horizon, normalize(ray));
    color = vec4(mix(low, high, sqrt(max(0.0, up))), 1.0);
}
"""

COLOR = (
    _FACING
    + """
uniform sampler2D atlas;
uniform sampler2D levels;
uniform sampler2D lights;
uniform sampler2D shadow;
uniform int light_count;
uniform bool shadowed;
uniform mat4 to_shadow;
uniform vec2 offset;
uniform vec3 ambient;
uniform vec3 up;
uniform float hemisphere;
uniform vec3 sun;
uniform vec3 sun_color;
out vec4 color;

float number(int light, int place) {
    return texelFetch(lights, ivec2(place / 4, light), 0)[place % 4];
}

vec3 numbers(int light, int place) {
    return vec3(number(light, place), number(light, place + 1), number(light, place + 2));
}

float light_intensity(int light, vec3 normal) {
    float kind = number(light, 0);
    vec3 shines = numbers(light, 4);
    vec3 up = normalize(normal);
    if (kind == 2.0) return max(0.0, -dot(up, shines));
    vec3 way = numbers(light, 1) - seen_place;
    float distance = length(way) + 1e-12;
    float facing = dot(up, way) / distance;
    if (distance > number(light, 10) || facing <= 0.0) return 0.0;
    float fading = number(light, 11) + number(light, 12) * distance + number(light, 13) * distance * distance;
    float intensity = facing / max(fading, 1e-6);
    if (kind == 1.0) {
        float along = -dot(way, shines) / distance;
        float inner = number(light, 14), outer = number(light, 15);
        if (along <= outer) return 0.0;
        if (along < inner) intensity *= pow((along - outer) / (inner - outer), number(light, 16));
    }
    return intensity;
}

float compared(ivec2 place, float depth) {
    return texelFetch(shadow, place, 0).r >= depth ? 1.0 : 0.0;
}

float sunshine(vec3 normal) {
    vec3 here = (to_shadow * vec4(seen_place + offset.x * normal, 1.0)).xyz - vec3(0.0, 0.0, offset.y);
    ivec2 size = textureSize(shadow, 0) - 1;
    if (any(lessThan(here.xy, vec2(0.0))) || any(greaterThanEqual(here.xy, vec2(size)))) return 1.0;
    ivec2 corner = ivec2(here.xy);
    vec2 share = here.xy - vec2(corner);
    float upper = mix(compared(corner, here.z), compared(corner + ivec2(1, 0), here.z), share.x);
    float lower = mix(compared(corner + ivec2(0, 1), here.z), compared(corner + ivec2(1, 1), here.z), share.x);
    return mix(upper, lower, share.y);
}

vec3 texel(int first, ivec2 place, ivec2 size) {
    int index = first + place.y * size.x + place.x;
    return texelFetch(atlas, ivec2(index % 4096, index / 4096), 0).rgb;
}

vec3 textured(int level, int count) {
    vec3 row = texelFetch(levels, ivec2(level, 0), 0).xyz;
    vec2 across = dFdx(seen_uv) * row.yz, along = dFdy(seen_uv) * row.yz;
    float size = max(dot(across, across), dot(along, along));
    int smaller = size <= 1.0 ? 0 : min(count - 1, int(0.5 * log2(size) + 0.5));
    row = texelFetch(levels, ivec2(level + smaller, 0), 0).xyz;
    ivec2 extent = ivec2(row.yz);
    vec2 place = vec2(seen_uv.x, 1.0 - seen_uv.y) * row.yz - 0.5;
    vec2 corner = floor(place), share = place - corner;
    ivec2 a = ivec2(mod(corner, row.yz)), b = ivec2(mod(corner + 1.0, row.yz));
    int first = int(row.x);
    vec3 upper = mix(texel(first, a, extent), texel(first, ivec2(b.x, a.y), extent), share.x);
    vec3 lower = mix(texel(first, ivec2(a.x, b.y), extent), texel(first, b, extent), share.x);
    return mix(upper, lower, share.y);
}

void main() {
    vec4 look = texelFetch(parts, ivec2(5, seen_part), 0);
    vec3 paint = look.x < 0.0 ? vec3(1.0) : textured(int(look.x), int(look.y));
    if (hidden()) discard;
    vec3 normal = gl_FrontFacing ? seen_normal : -seen_normal;
    float lit = max(0.0, dot(normal, sun));
    if (shadowed && lit > 0.0) lit *= sunshine(normal);
    vec3 irradiance = ambient * (1.0 + hemisphere * dot(normal, up)) + lit * sun_color;
    for (int light = 0; light < light_count; light++) irradiance += light_intensity(light, normal) * numbers(light, 7);
    vec4 material = texelFetch(parts, ivec2(3, seen_part), 0);
    vec3 glow = texelFetch(parts, ivec2(4, seen_part), 0).rgb;
    color = vec4(clamp(material.rgb * irradiance * paint + glow, 0.0, 1.0), material.a);
}
"""
)
