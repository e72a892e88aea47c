/* Words in which rows of tables of inputs are written. */
#ifndef INPUT_ROWS_H
#define INPUT_ROWS_H

#include "job_spec.h"
#include "spec_fields.h"

#define RANGE(low, high) .minimum = (low), .maximum = (high)
#define USUAL(low, high) .usual_low = (low), .usual_high = (high)
#define SLIP(unit, factor) .slip_unit = (unit), .slip_factor = (factor)
#define COLUMN(name, kind, member) .column = (name), .column_kind = COLUMN_##kind, .column_at = offsetof(job_spec, member)
#define LISTED .is_listed = true
#define IN_VIEW(place) .in_view = (place)
#define IN_LIST(order, before, by, after) .list_order = (order), .list_before = (before), .list_factor = (by), .list_after = (after)
#define IN_FORM(place, in) .form_order = (place), .form_unit = (in)
#define FREE_OF_BED .is_free_of_bed = true
#define ACTS_LATER .acts_later = true
#define OPEN_RANGE(low, high) .minimum = (low), .minimum_open = true, .maximum = (high)

#endif
