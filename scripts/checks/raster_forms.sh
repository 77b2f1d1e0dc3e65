#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints every form in which GDAL can write a raster, whether Sandwall reads it as GDAL does, and the formats that GDAL
# cannot write. Build import_tests before.
#   raster_forms.sh [BUILD]
set -euo pipefail
cd "$(dirname "$0")/../.."
SANDWALL_PRINT_FORMS=1 "${1:-build/release}/bin/import_tests" --gtest_filter='RasterForms.*' --gtest_brief=1
