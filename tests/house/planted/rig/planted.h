// SPDX-License-Identifier: BSD-3-Clause
//
// An include against the order of folders, which scripts/includes has to find.
#pragma once

#include "lightmap/lightmap.h"
