/* The material in the input languages of other programs: LAMMPS (pair_style granular), LIGGGHTS-PUBLIC 3.8, MercuryDPM and Yade. Each
 * is a frame for contacts between spheres of one material; walls take the same lines with the wall's friction. What means something
 * else there is converted:
 *
 *   rolling           here a moment of at most mu_r R* N, R* = R_i R_j/(R_i + R_j), from a spring of stiffness K_T R*^2
 *   LAMMPS sds        the same: F = k_roll R* theta, moment R* F, F <= mu_roll N. Damping by names that versions from 2020 on know
 *   LIGGGHTS epsd2    the same; its cdt is the constant torque
 *   MercuryDPM        the same with 2 R* in the place of R*: mu_r/2 and K_T/4
 *   Yade, CohFrictMat a moment of at most etaRoll R N from a spring of alphaKr ks R^2: mu_r/2 and 1/4 for equal spheres; kn = young R
 */
#include <math.h>
#include <string.h>

#include "card.h"
#include "dem_rules.h"
#include "text_buffer.h"

enum { LONGEST_SNIPPET = 8000 };

/* What the lines are made of. */
typedef struct material {
    const dem_scene_definition *scene;
    const dem_contact_parameters *contact;
    bool is_hertz;
    double diameter, density, mass; /* of the largest species */
    double k_t;                     /* N/m; NaN of Hertz-Mindlin, whose stiffness goes with the overlap */
    double gamma;                   /* 1/s, over the reduced mass of two: the damping that gives the restitution; of linear laws */
} material;

static material material_of(const job_spec *spec)
{
    const dem_contact_parameters *contact = &spec->scene.contact;
    material m = { .scene = &spec->scene, .contact = contact, .is_hertz = contact->law == DEM_HERTZ_MINDLIN, .k_t = NAN };
    for (size_t s = 0; s < spec->scene.species_count; s++) {
        if (!(dem_species_diameter(&spec->scene.species[s]) > m.diameter)) continue;
        m.diameter = dem_species_diameter(&spec->scene.species[s]);
        m.density = spec->scene.species[s].density;
    }
    m.mass = dem_sphere_mass(m.diameter, m.density);
    if (!m.is_hertz) m.k_t = contact->tangential_stiffness_ratio * contact->stiffness;
    const double loss = -log(contact->restitution), pi = acos(-1.0);
    if (!m.is_hertz) m.gamma = 2.0 * loss / sqrt(pi * pi + loss * loss) * sqrt(contact->stiffness / (0.5 * m.mass));
    return m;
}

/* LAMMPS' damping "tsuji" is a polynomial in the restitution (Tsuji, Tanaka & Ishida 1992) that stands for twice the reduced mass,
 * which it is used with: what is to be written there so that spheres of Hertz' law part with the restitution e, whose damping over
 * sqrt(m K) delta^(1/4) is known in closed form (Tsuji's alpha; Antypov & Elliott 2011). */
static double tsuji_restitution(double e)
{
    static const double c[] = { 1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218 };
    const double loss = -log(e), pi = acos(-1.0), wanted = loss * sqrt(5.0 / (loss * loss + pi * pi));
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 50; k++) {
        const double middle = 0.5 * (low + high);
        double alpha = 0.0;
        for (size_t i = sizeof c / sizeof c[0]; i-- > 0;) alpha = alpha * middle + c[i];
        if (alpha > wanted) low = middle;
        else high = middle;
    }
    return 0.5 * (low + high);
}

static void lammps(const material *m, text_buffer *out)
{
    const dem_contact_parameters *c = m->contact;
    text_buffer_print(out, "# diameter %.9g m, density %.9g kg/m3\npair_style granular\npair_coeff * * ", m->diameter, m->density);
    if (m->is_hertz)
        text_buffer_print(out, "hertz/material %.9g %.9g %.9g tangential mindlin NULL 0.5 %.9g", c->particle.youngs_modulus,
                          tsuji_restitution(c->restitution), c->particle.poissons_ratio, c->friction);
    else
        text_buffer_print(out, "hooke %.9g %.9g tangential linear_history %.9g %.9g %.9g", c->stiffness, m->gamma, m->k_t,
                          c->law == DEM_SPRING_DASHPOT ? 0.5 : 0.0, c->friction);
    if (c->rolling_friction > 0.0 && !m->is_hertz)
        text_buffer_print(out, " rolling sds %.9g 0.0 %.9g", m->k_t, c->rolling_friction);
    text_buffer_print(out, " damping %s\ntimestep %.3g\n", m->is_hertz ? "tsuji" : "mass_velocity", m->scene->time_step);
}

static void liggghts(const material *m, text_buffer *out)
{
    const dem_contact_parameters *c = m->contact;
    text_buffer_print(out, "# diameter %.9g m, density %.9g kg/m3\n", m->diameter, m->density);
    text_buffer_print(out, "fix mu all property/global coefficientFriction peratomtypepair 1 %.9g\n", c->friction);
    if (c->rolling_friction > 0.0)
        text_buffer_print(out, "fix mu_r all property/global coefficientRollingFriction peratomtypepair 1 %.9g\n",
                          c->rolling_friction);
    if (m->is_hertz) {
        text_buffer_print(out,
                          "fix e_n all property/global youngsModulus peratomtype %.9g\n"
                          "fix nu all property/global poissonsRatio peratomtype %.9g\n"
                          "fix e all property/global coefficientRestitution peratomtypepair 1 %.9g\n",
                          c->particle.youngs_modulus, c->particle.poissons_ratio, c->restitution);
    } else {
        text_buffer_print(
            out,
            "fix k_n all property/global kn peratomtypepair 1 %.9g\nfix k_t all property/global kt peratomtypepair 1 %.9g\n"
            "fix g_n all property/global gamman peratomtypepair 1 %.9g\n"
            "fix g_t all property/global gammat peratomtypepair 1 %.9g\n",
            c->stiffness, m->k_t, m->gamma, c->law == DEM_SPRING_DASHPOT ? 0.5 * m->gamma : 0.0);
    }
    text_buffer_print(out, "pair_style gran model %s tangential history%s\npair_coeff * *\ntimestep %.3g\n",
                      m->is_hertz ? "hertz" : "hooke/stiffness",
                      !(c->rolling_friction > 0.0)            ? ""
                      : c->rolling_law == DEM_CONSTANT_TORQUE ? " rolling_friction cdt"
                                                              : " rolling_friction epsd2",
                      m->scene->time_step);
}

static void mercurydpm(const material *m, text_buffer *out)
{
    const dem_contact_parameters *c = m->contact;
    if (m->is_hertz) {
        text_buffer_print(
            out,
            "HertzianViscoelasticMindlinRollingTorsionSpecies species;\nspecies.setDensity(%.9g);\n"
            "species.setEffectiveElasticModulusAndRestitutionCoefficient(%.9g, %.9g);\n"
            "species.setEffectiveShearModulus(%.9g);\n",
            m->density, c->particle.youngs_modulus / (2.0 * (1.0 - pow(c->particle.poissons_ratio, 2.0))), c->restitution,
            c->particle.youngs_modulus / (4.0 * (1.0 + c->particle.poissons_ratio) * (2.0 - c->particle.poissons_ratio)));
    } else {
        text_buffer_print(out,
                          "LinearViscoelasticFrictionSpecies species;\nspecies.setDensity(%.9g);\n"
                          "species.setStiffnessAndRestitutionCoefficient(%.9g, %.9g, %.9g);\nspecies.setSlidingStiffness(%.9g);\n",
                          m->density, c->stiffness, c->restitution, m->mass, m->k_t);
        if (c->law == DEM_SPRING_DASHPOT)
            text_buffer_print(out, "species.setSlidingDissipation(0.5 * species.getDissipation());\n");
    }
    text_buffer_print(out, "species.setSlidingFrictionCoefficient(%.9g);\n", c->friction);
    if (c->rolling_friction > 0.0 && !m->is_hertz)
        text_buffer_print(out, "species.setRollingStiffness(%.9g);\nspecies.setRollingFrictionCoefficient(%.9g);\n", 0.25 * m->k_t,
                          0.5 * c->rolling_friction);
    text_buffer_print(out, "setTimeStep(%.3g); // spheres of radius %.9g\n", m->scene->time_step, 0.5 * m->diameter);
}

static void yade(const material *m, text_buffer *out)
{
    const dem_contact_parameters *c = m->contact;
    if (m->is_hertz) {
        text_buffer_print(
            out,
            "# spheres of radius %.9g\nO.materials.append(FrictMat(young=%.9g, poisson=%.9g, frictionAngle=%.9g, density=%.9g))\n"
            "# in InteractionLoop: Ip2_FrictMat_FrictMat_MindlinPhys(en=%.9g, es=%.9g), Law2_ScGeom_MindlinPhys_Mindlin()\n",
            0.5 * m->diameter, c->particle.youngs_modulus, c->particle.poissons_ratio, atan(c->friction), m->density,
            c->restitution, c->restitution);
    } else {
        text_buffer_print(
            out,
            "# spheres of radius %.9g\nO.materials.append(CohFrictMat(young=%.9g, poisson=%.9g, frictionAngle=%.9g, density=%.9g,\n"
            "    isCohesive=False, momentRotationLaw=True, alphaKr=0.25, etaRoll=%.9g, alphaKtw=0, etaTwist=0))\n"
            "# in InteractionLoop: Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(), Law2_ScGeom6D_CohFrictPhys_CohesionMoment()\n",
            0.5 * m->diameter, c->stiffness / (0.5 * m->diameter), c->tangential_stiffness_ratio, atan(c->friction), m->density,
            0.5 * c->rolling_friction);
    }
    text_buffer_print(out, "O.dt = %.3g\n", m->scene->time_step);
}

/* --- what does not carry over --- */

enum program { LAMMPS, LIGGGHTS, MERCURYDPM, YADE, PROGRAMS };

static void say(json_t *list, bool is_so, const char *sentence)
{
    if (is_so) json_array_append_new(list, json_string(sentence));
}

static json_t *losses_of(const job_spec *spec, const material *m, enum program program)
{
    const dem_contact_parameters *c = m->contact;
    const bool rolls = c->rolling_friction > 0.0, is_constant = c->rolling_law == DEM_CONSTANT_TORQUE;
    json_t *list = json_array();
    say(list, c->law == DEM_WALTON_BRAUN,
        "The latching spring unloads along a steeper line and loses no more where contacts last; a dashpot of the same restitution "
        "stands for it, and takes part of slow motion, too.");
    say(list, c->law == DEM_WALTON_BRAUN,
        "Friction whose stiffness falls as a contact slips is a spring of its first stiffness there.");
    say(list, program == YADE && !m->is_hertz,
        "This law has no dashpot: restitution is 1 but for NewtonIntegrator's damping, which is to be chosen by a collision.");
    say(list, program == LAMMPS && m->is_hertz,
        "The number after Young's modulus stands for the restitution by LAMMPS' damping \"tsuji\"; it is less than the "
        "restitution.");
    say(list, (program == LAMMPS || program == LIGGGHTS) && !m->is_hertz,
        "The damping is that of two spheres of this size: another size, or a wall, gets another restitution.");
    say(list, rolls && is_constant && program != LIGGGHTS,
        "The constant rolling torque is a spring that yields at the same moment.");
    say(list, rolls && c->rolling_law == DEM_EPSD_DAMPED, "The dashpot of rolling is left out.");
    say(list, rolls && m->is_hertz && program != LIGGGHTS,
        "Rolling friction is left out: its stiffness follows the overlap here and is a number there; the slopes will be lower.");
    say(list, program == YADE && rolls && !m->is_hertz, "Its rolling is as here between spheres of one size alone.");
    say(list, program == MERCURYDPM && rolls && !m->is_hertz,
        "Its rolling coefficient counts in 2 R*, so it is half of that here; another convention would change the slopes.");
    say(list, c->cohesion_law != DEM_NO_COHESION, "Cohesion is left out: without it the material flows more freely.");
    say(list, spec->scene.species_count > 1 || spec->scene.has_pairs,
        "Species and materials that differ: the lines are of the largest alone.");
    for (size_t s = 0; s < spec->scene.species_count; s++)
        if (spec->scene.species[s].cluster.sphere_count > 0) {
            say(list, true, "Particles of several spheres: each sphere has these contacts, the rigid body is to be made there.");
            break;
        }
    say(list, true, "Walls have a friction of their own (card/wall).");
    return list;
}

json_t *snippets_to_json(const plan_fit *fit)
{
    static const struct {
        const char *name;
        void (*write)(const material *m, text_buffer *out);
    } programs[PROGRAMS] = { { "lammps", lammps }, { "liggghts", liggghts }, { "mercurydpm", mercurydpm }, { "yade", yade } };
    job_spec spec;
    if (!card_spec(fit, &spec)) return NULL;
    json_t *snippets = strcmp(spec.process, "granule") == 0 ? NULL : json_object();
    const material m = snippets ? material_of(&spec) : (material){ .diameter = 0.0 };
    for (int p = 0; snippets && p < PROGRAMS; p++) {
        text_buffer text;
        text_buffer_init(&text, LONGEST_SNIPPET);
        programs[p].write(&m, &text);
        if (!text.failed)
            json_object_set_new(
                snippets, programs[p].name,
                json_pack("{s:s, s:o}", "text", text.text, "does_not_carry_over", losses_of(&spec, &m, (enum program)p)));
        text_buffer_clear(&text);
    }
    job_spec_clear(&spec);
    return snippets;
}
