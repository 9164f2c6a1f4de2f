"""Server of ``type_description_interfaces/srv/GetTypeDescription``."""

from __future__ import annotations

from typing import Any

from daidalos.interfaces.description import Description, IndividualDescription, describe
from daidalos.interfaces.parser import InterfaceError


def fill_response(request: Any, response: Any) -> Any:
    """Describe the type that a request names, with its sources if they are wanted."""
    from rosidl_runtime_py.get_interfaces import interface_library

    library = interface_library()
    try:
        description = describe(library.get(request.type_name), library.get)
    except (LookupError, ValueError, InterfaceError) as error:
        response.successful = False
        response.failure_reason = f"Type '{request.type_name}' is not known: {error}"
        return response
    if request.type_hash and request.type_hash != description.type_hash():
        response.successful = False
        response.failure_reason = f"The hash of '{request.type_name}' is {description.type_hash()} here"
        return response
    response.successful = True
    response.type_description = _message(description)
    if request.include_type_sources:
        response.type_sources = _sources(description, library)
    return response


def _message(description: Description) -> Any:
    from type_description_interfaces.msg import TypeDescription

    return TypeDescription(
        type_description=_individual(description.type_description),
        referenced_type_descriptions=[_individual(other) for other in description.referenced],
    )


def _individual(description: IndividualDescription) -> Any:
    from type_description_interfaces.msg import Field, FieldType, IndividualTypeDescription

    fields = [
        Field(
            name=field.name,
            type=FieldType(
                type_id=field.type_id,
                capacity=field.capacity,
                string_capacity=field.string_capacity,
                nested_type_name=field.nested_type_name,
            ),
            default_value=field.default_value,
        )
        for field in description.fields
    ]
    return IndividualTypeDescription(type_name=description.type_name, fields=fields)


def _sources(description: Description, library: Any) -> list[Any]:
    from type_description_interfaces.msg import TypeSource

    sources = []
    for one in (description.type_description, *description.referenced):
        base = one.type_name.split("_")[0] if "/msg/" not in one.type_name else one.type_name
        path = library.path(base)
        if base == one.type_name:
            text = path.read_text(encoding="utf-8")
            sources.append(TypeSource(type_name=one.type_name, encoding=path.suffix[1:], raw_file_contents=text))
        else:
            sources.append(TypeSource(type_name=one.type_name, encoding="implicit"))
    return sources
