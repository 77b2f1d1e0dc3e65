# SPDX-License-Identifier: Apache-2.0
# Adds to the tree of the package what Debian wants: copyright, changelog and compressed man pages. CPack runs this script
# before it writes the package. The time of the changelog is SOURCE_DATE_EPOCH if it is set.
set(tree "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr")
set(docs "${tree}/share/doc/sandwall")

# The web page contains works of others.
if(EXISTS "${tree}/share/sandwall/web")
    set(page
"
Files: usr/share/sandwall/web/*
Copyright: 2026 the Sandwall authors
 and the authors whom usr/share/sandwall/web/licences.txt names
License: Sandwall-web-page
 Sandwall's own part is licensed under the Apache License, Version 2.0. The page
 also contains three.js, fmt, fast_float, zstd, xxHash, and the libraries of
 emscripten. Their licences are in /usr/share/sandwall/web/licences.txt.
")
endif()

file(WRITE "${docs}/copyright"
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Sandwall

Files: *
Copyright: 2026 the Sandwall authors
License: Apache-2.0
 Licensed under the Apache License, Version 2.0. On Debian systems the full text
 is in /usr/share/common-licenses/Apache-2.0.
${page}")
file(REMOVE "${docs}/LICENSE")  # copyright names the licence, which every Debian system has

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${docs}/changelog"
"sandwall (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * CHANGELOG.md in this folder lists the changes of this version.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
file(GLOB pages "${tree}/share/man/man1/*.1")
execute_process(COMMAND gzip -9nf "${docs}/changelog" ${pages} COMMAND_ERROR_IS_FATAL ANY)
