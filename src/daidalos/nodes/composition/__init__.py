"""Components of the tutorials on containers."""

COMPONENTS = {name: f"_components:{name}" for name in ("Talker", "Listener", "NodeLikeListener", "Server", "Client")}
