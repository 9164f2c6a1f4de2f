"""The components of the lessons on containers."""

COMPONENTS = {name: f"_components:{name}" for name in ("Client", "Listener", "Server", "Talker")}
