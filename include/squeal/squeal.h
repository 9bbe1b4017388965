/*
   squeal - all rooms.
*/
#pragma once

#include <squeal/sys.h>
#include <squeal/model.h>
#include <squeal/contact.h>
#include <squeal/sound.h>
#include <squeal/operators.h>
#include <squeal/pencil.h>
#include <squeal/statics.h>
#include <squeal/modes.h>
#include <squeal/sweep.h>
#include <squeal/quiet.h>
#include <squeal/design.h>
#include <squeal/sample.h>
#include <squeal/frf.h>
#include <squeal/substructure.h>
#include <squeal/projector.h>
#include <squeal/dynamics.h>
#include <squeal/reduced.h>
#include <squeal/map.h>
#include <squeal/cycle.h>
#include <squeal/results.h>
