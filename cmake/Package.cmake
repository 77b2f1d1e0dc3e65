# SPDX-License-Identifier: Apache-2.0
# The Debian package that scripts/package.sh makes with CPack from the release tree.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sandwall)
set(CPACK_PACKAGE_VENDOR Sandwall)
# lintian refuses the address of a host that cannot exist.
set(SANDWALL_MAINTAINER "Sandwall maintainers <maintainers@users.noreply.github.com>" CACHE STRING "The package's maintainer")
set(CPACK_PACKAGE_CONTACT "${SANDWALL_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "interactive sand for display walls, with haptic feedback")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"People touch sand that a whole display cluster shows: a wall of stereo
projectors, a CAVE or a desktop. Every tile computes the same sand, bit for
bit, so only the path of the hand crosses the network.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# dpkg-shlibdeps finds the libraries. The launcher is a script, and it starts mpirun.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.11), openmpi-bin")
if(NOT OSMESA_FOUND)
    # EGL loads its software renderer, which is the only one that needs no card and no display.
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libegl-mesa0, libgl1-mesa-dri")
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libgl1-mesa-dri, libegl-mesa0, libxcursor1, openssh-client")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS ffmpeg)
# Copyright, changelog and compressed pages, as Debian wants them.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/finish_package.cmake)
include(CPack)
