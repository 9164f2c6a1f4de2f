"""Operations on the way along a route, one class each."""
