"""Operations of the protocol."""
