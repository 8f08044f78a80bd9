// SPDX-License-Identifier: BSD-3-Clause
//
// An include against the order of a folder's rooms, which scripts/includes has to find.
#pragma once

#include "survey/fit/fit.h"
