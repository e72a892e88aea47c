/* The text has every input but those whose row of the table says that they act later, and the numbers derived from them: a stiffness
 * that is chosen for the speed of the drum, say, and the time step that follows from it. */
#include "spec_bed.h"

#include <stddef.h>

#include "checksum.h"
#include "process_type.h"
#include "spec_text.h"

/* Of what the core is given, all that may follow from an input that acts later. */
static json_t *derived_numbers(const dem_scene_definition *scene)
{
    const dem_contact_parameters *contact = &scene->contact;
    json_t *numbers = json_pack("[f, f, f, f, f, f, f]", scene->time_step, contact->stiffness, contact->restitution,
                                contact->unloading_slope, contact->particle.youngs_modulus, contact->wall.youngs_modulus,
                                scene->lifters.angle /* the other way in a drum that turns back */);
    if (scene->has_pairs) json_array_append_new(numbers, json_integer((json_int_t)checksum_of(scene->pair, sizeof scene->pair)));
    return numbers;
}

static bool has_clusters(const dem_scene_definition *scene)
{
    for (size_t s = 0; s < scene->species_count; s++)
        if (scene->species[s].cluster.sphere_count) return true;
    return false;
}

/* Nothing settles where particles are placed one by one, come from another's bed or enter in a stream. Several beds each settle
 * their own. */
static bool settles(const job_spec *spec)
{
    const bool advances_a_scene = spec->type->inputs_at == offsetof(job_spec, inputs);
    return advances_a_scene && spec->bed_count == 1 && !spec->scene.is_placed && !(spec->scene.stream.rate > 0.0);
}

char *spec_bed_text(const job_spec *spec)
{
    if (!settles(spec)) return NULL;
    /* Spheres are their own mirror image, and so are bars along the radius. */
    const bool is_mirrored = spec->is_mirrored && (has_clusters(&spec->scene) || spec->scene.lifters.angle != 0.0);
    json_t *bed =
        json_pack("{s:s, s:o, s:o, s:b}", "process", spec->process, "inputs", spec_inputs_of_bed(spec->type->inputs, &spec->inputs),
                  "derived", derived_numbers(&spec->scene), "mirrored", is_mirrored);
    char *text = bed ? json_dumps(bed, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(bed);
    return text;
}
