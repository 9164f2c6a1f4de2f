"""Vehicles for the tests of drives."""

WHEEL = (
    "<link name='{name}'><pose>{x} {y} {r} -1.5707963267948966 0 0</pose><inertial><mass>1</mass>"
    "<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>"
    "<collision name='c'><geometry><cylinder><radius>{r}</radius><length>0.05</length></cylinder></geometry>"
    "</collision></link>"
)


def inertia(mass, moment):
    moments = "".join(f"<{axis}>{moment}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"<inertial><mass>{mass}</mass><inertia>{moments}</inertia></inertial>"


def four_wheels(plugin, base=0.6, track=0.5, radius=0.1, steered=False, length=0.7):
    """Return the SDF of a cart: chassis at z 0.2, wheels fl, fr, rl, rr on joints of the same name with ``_j``."""
    parts = [
        f"<link name='chassis'><pose>0 0 0.2 0 0 0</pose>{inertia(10, 0.4)}<collision name='c'><geometry><box>"
        f"<size>{length} 0.3 0.1</size></box></geometry></collision></link>"
    ]
    for name, x, y in (
        ("fl", base / 2, track / 2),
        ("fr", base / 2, -track / 2),
        ("rl", -base / 2, track / 2),
        ("rr", -base / 2, -track / 2),
    ):
        parts.append(WHEEL.format(name=name, x=x, y=y, r=radius))
        parent = "chassis"
        if steered and name[0] == "f":
            parent = f"{name}_knuckle"
            parts.append(f"<link name='{parent}'><pose>{x} {y} {radius} 0 0 0</pose>{inertia(0.5, 0.005)}</link>")
            parts.append(
                f"<joint name='{name}_steer' type='revolute'><parent>chassis</parent><child>{parent}</child><axis>"
                "<xyz>0 0 1</xyz><limit><lower>-0.8</lower><upper>0.8</upper></limit></axis></joint>"
            )
        parts.append(
            f"<joint name='{name}_j' type='revolute'><parent>{parent}</parent><child>{name}</child>"
            "<axis><xyz>0 0 1</xyz></axis></joint>"
        )
    return f"<model name='cart'>{''.join(parts)}{plugin}</model>"
