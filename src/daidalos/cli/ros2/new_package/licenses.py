"""Texts of licences by their SPDX identifiers."""

from __future__ import annotations

import datetime

LICENSES = (
    "Apache-2.0", "BSL-1.0", "BSD-2.0", "BSD-2-Clause", "BSD-3-Clause", "GPL-3.0-only", "LGPL-3.0-only", "MIT", "MIT-0",
)  # fmt: skip
"""Identifiers of licences with a LICENSE file."""


def license_text(identifier: str, holder: str) -> str | None:
    """Return the text of a licence, None for an unknown one.

    The GNU licences are given by the notice that refers to them.

    Parameters
    ----------
    identifier
        Such as ``MIT``.
    holder
        Who holds the copyright.
    """
    if identifier == "Apache-2.0":
        return _apache()
    template = _TEXTS.get(identifier)
    year = datetime.datetime.now(tz=datetime.UTC).year
    return None if template is None else template.format(notice=f"Copyright (c) {year} {holder}")


def _apache() -> str | None:
    """Return the licence of this project."""
    from importlib.metadata import files

    for path in files("daidalos") or ():
        if path.name == "LICENSE":
            return path.read_text(encoding="utf-8")
    return None


_PERMISSION = """\
Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so"""

_NO_WARRANTY = """\
THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.
"""

_BSD_CONDITIONS = """\
Redistribution and use in source and binary forms, with or without
modification, are permitted provided that the following conditions are met:

1. Redistributions of source code must retain the above copyright notice,
   this list of conditions and the following disclaimer.

2. Redistributions in binary form must reproduce the above copyright notice,
   this list of conditions and the following disclaimer in the documentation
   and/or other materials provided with the distribution.
"""

_BSD_NO_ENDORSEMENT = """\

3. Neither the name of the copyright holder nor the names of its contributors
   may be used to endorse or promote products derived from this software
   without specific prior written permission.
"""

_BSD_NO_WARRANTY = """
THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS"
AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE
IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE
DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDER OR CONTRIBUTORS BE LIABLE
FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL
DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR
SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER
CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY,
OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE
OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
"""

_GNU = """\
{{notice}}

This program is free software: you can redistribute it and/or modify it under
the terms of the GNU {} as published by the Free
Software Foundation, version 3.

This program is distributed in the hope that it will be useful, but WITHOUT
ANY WARRANTY; without even the implied warranty of MERCHANTABILITY or FITNESS
FOR A PARTICULAR PURPOSE. See the GNU {} for more
details.

You should have received a copy of the GNU {} along
with this program. If not, see <https://www.gnu.org/licenses/>.
"""

_BSD_2 = f"{{notice}}\n\n{_BSD_CONDITIONS}{_BSD_NO_WARRANTY}"
_BSD_3 = f"{{notice}}\n\n{_BSD_CONDITIONS}{_BSD_NO_ENDORSEMENT}{_BSD_NO_WARRANTY}"

_TEXTS = {
    "BSL-1.0": """\
Boost Software License - Version 1.0 - August 17th, 2003

{notice}

Permission is hereby granted, free of charge, to any person or organization
obtaining a copy of the software and accompanying documentation covered by
this license (the "Software") to use, reproduce, display, distribute, execute,
and transmit the Software, and to prepare derivative works of the Software,
and to permit third-parties to whom the Software is furnished to do so, all
subject to the following:

The copyright notices in the Software and this entire statement, including the
above license grant, this restriction and the following disclaimer, must be
included in all copies of the Software, in whole or in part, and all
derivative works of the Software, unless such copies or derivative works are
solely in the form of machine-executable object code generated by a source
language processor.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE, TITLE AND NON-INFRINGEMENT. IN NO EVENT
SHALL THE COPYRIGHT HOLDERS OR ANYONE DISTRIBUTING THE SOFTWARE BE LIABLE FOR
ANY DAMAGES OR OTHER LIABILITY, WHETHER IN CONTRACT, TORT OR OTHERWISE,
ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER
DEALINGS IN THE SOFTWARE.
""",
    "BSD-2.0": _BSD_3,
    "BSD-2-Clause": _BSD_2,
    "BSD-3-Clause": _BSD_3,
    "GPL-3.0-only": _GNU.format(*["General Public License"] * 3),
    "LGPL-3.0-only": _GNU.format(*["Lesser General Public License"] * 3),
    "MIT": (
        f"MIT License\n\n{{notice}}\n\n{_PERMISSION}, subject to the following conditions:\n\n"
        "The above copyright notice and this permission notice shall be included in all\n"
        f"copies or substantial portions of the Software.\n\n{_NO_WARRANTY}"
    ),
    "MIT-0": f"MIT No Attribution\n\n{{notice}}\n\n{_PERMISSION}.\n\n{_NO_WARRANTY}",
}
