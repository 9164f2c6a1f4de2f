"""Converting between structured and plain arrays, under the names that older programs use."""

from numpy.lib.recfunctions import structured_to_unstructured as structured_to_unstructured
from numpy.lib.recfunctions import unstructured_to_structured as unstructured_to_structured
