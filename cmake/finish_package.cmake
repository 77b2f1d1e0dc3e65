# SPDX-License-Identifier: Apache-2.0
# Adds to the tree of the package what Debian wants: copyright, changelog and compressed man pages. CPack runs this script
# before it writes the package. The time of the changelog is SOURCE_DATE_EPOCH if it is set.
set(tree "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr")
set(docs "${tree}/share/doc/sandwall")

file(WRITE "${docs}/copyright"
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Sandwall

Files: *
Copyright: 2026 the Sandwall authors
License: Apache-2.0
 Licensed under the Apache License, Version 2.0. On Debian systems the full text
 is in /usr/share/common-licenses/Apache-2.0.
")
file(REMOVE "${docs}/LICENSE")  # copyright names the licence, which every Debian system has

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${docs}/changelog"
"sandwall (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * CHANGELOG.md in this folder lists the changes of this version.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
file(GLOB pages "${tree}/share/man/man1/*.1")
execute_process(COMMAND gzip -9nf "${docs}/changelog" ${pages} COMMAND_ERROR_IS_FATAL ANY)
