"""Reader of SDF 1.4 to 1.11: worlds and models with all includes read and all poses resolved."""

from daidalos.description.sdf.reader import load, load_model, parse, parse_any, parse_model

__all__ = ["load", "load_model", "parse", "parse_any", "parse_model"]
