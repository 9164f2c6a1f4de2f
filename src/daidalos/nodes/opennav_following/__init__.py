"""Server that follows objects."""

COMPONENTS = {"FollowingServer": "_following_server:FollowingServer"}
