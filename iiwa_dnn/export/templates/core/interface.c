/* The layout that tables describe. */
struct layout {
    step_memory_ArmPlan plan;
    const double *places;
};

typedef char layout_has_room[sizeof(struct layout) <= sizeof(((struct armstep *)NULL)->laid_out) ? 1 : -1];

enum { STATE = 1 }; /* where an arm's state begins in its memory, behind the digest of the tables */

static const step_memory_ArmPlan *plan_of(const struct armstep *arm)
{
    return &((const struct layout *)(const void *)arm->laid_out)->plan;
}

static bool is_shield(const struct armstep *arm)
{
    return arm->tables->kind == ARMSTEP_SHIELD;
}

static ptrdiff_t request_width(const struct armstep *arm, int kind)
{
    const ptrdiff_t asked = kind == ARMSTEP_REQUEST_TWIST ? 6 : arm->tables->joints;
    return is_shield(arm) ? asked : ARMSTEP_TARGET * arm->tables->frames;
}

/* View numbers for kernels, whose arrays have one type whether they are written or not. */
static Vector view(const double *numbers, ptrdiff_t count)
{
    const Vector own = {(double *)numbers, count};
    return own;
}

/* View numbers that may be left out: NULL. */
static Vector view_if_any(const double *numbers, ptrdiff_t count)
{
    static const double nothing[1] = {0.0};
    return numbers != NULL ? view(numbers, count) : view(nothing, 0);
}

static Vector numbers_of(const struct armstep *arm, const double *memory)
{
    return view(memory + STATE, arm->tables->memory - STATE);
}

static step_memory_ArmState state_of(const struct armstep *arm, const double *memory)
{
    return @arm_state@plan_of(arm), numbers_of(arm, memory));
}

static struct arena arena_of(const struct armstep *arm, double *scratch)
{
    char *const start = (char *)scratch;
    const struct arena own = {start, start, (char *)(scratch + arm->tables->scratch), false, arm->tables};
    return own;
}

static step_state_MotionState motion_state_of(const struct armstep *arm, const double *memory)
{
    const step_memory_ArmState state = state_of(arm, memory);
    return @motion_of@plan_of(arm), &state);
}

/* FNV-1a of 64 bits. */
static uint64_t digested(uint64_t digest, uint64_t number)
{
    for (int i = 0; i < 8; i++) {
        digest = (digest ^ (number & 0xffu)) * UINT64_C(0x100000001b3);
        number >>= 8;
    }
    return digest;
}

static uint64_t digested_numbers(uint64_t digest, const double *numbers, ptrdiff_t count)
{
    for (ptrdiff_t k = 0; k < count; k++) {
        uint64_t bits;
        memcpy(&bits, numbers + k, sizeof bits);
        digest = digested(digest, bits);
    }
    return digest;
}

static const char *const part_names[ARMSTEP_PARTS] = {
    "",
@part_names@
};

const char *armstep_part_name(const struct armstep_tables *tables, ptrdiff_t number)
{
    if (number >= 0 && number < ARMSTEP_PARTS) {
        return part_names[number];
    }
    const ptrdiff_t k = number - ARMSTEP_PARTS;
    return k >= 0 && k < tables->own_count ? tables->own[k].name : "";
}

int armstep_part_number(const struct armstep_tables *tables, const char *name)
{
    const int count = ARMSTEP_PARTS + (int)tables->own_count;
    for (int k = 1; k < count; k++) {
        const char *own = armstep_part_name(tables, k);
        ptrdiff_t at = 0;
        while (own[at] == name[at] && own[at] != '\0') {
            at++;
        }
        if (own[at] == name[at]) {
            return k;
        }
    }
    return 0;
}

uint64_t armstep_digest(const struct armstep_tables *tables)
{
    ptrdiff_t next = 0; /* part, whose name counts in place of its number */
    uint64_t digest = digested_numbers(UINT64_C(0xcbf29ce484222325), tables->numbers, tables->number_count);
    for (ptrdiff_t k = 0; k < tables->integer_count; k++) {
        if (next < tables->part_count && tables->parts[next] == k) {
            const char *name = armstep_part_name(tables, tables->integers[k]);
            for (; *name != '\0'; name++) {
                digest = digested(digest, (unsigned char)*name);
            }
            next++;
        } else {
            digest = digested(digest, (uint64_t)tables->integers[k]);
        }
    }
    return digest;
}

/* The digest as a number that copies of doubles keep: its first 52 bits. */
static double mark_of(const struct armstep *arm)
{
    return (double)(arm->tables->digest >> 12);
}

static bool has_begun(const struct armstep *arm, const double *memory)
{
    return memory[0] == mark_of(arm);
}

/* Test what commands rely on: NaN and infinities, subnormal numbers, products that are rounded. */
static bool computes_as_ieee(void)
{
    volatile double zero = 0.0;
    volatile double least = DBL_MIN;
    volatile double factor = 1.0 + 1.0 / 1073741824.0;
    const double nothing = zero / zero;
    const double a = factor;
    const double rounded = 1.0 + 2.0 / 1073741824.0; /* a * a to 53 bits */
    return !(nothing == nothing) && 1.0 / zero > DBL_MAX && least / 2.0 > 0.0 && a * a - rounded == 0.0;
}

/* Test the numbers of parts, of which 0 is none. */
static bool knows_parts(const struct armstep_tables *tables)
{
    for (ptrdiff_t k = 0; k < tables->part_count; k++) {
        const ptrdiff_t place = tables->parts[k];
        if (place < 0 || place >= tables->integer_count || tables->integers[place] < 0
            || tables->integers[place] >= ARMSTEP_PARTS + tables->own_count) {
            return false;
        }
    }
    return true;
}

static bool is_laid_out(const struct armstep *arm, struct reader *reader)
{
    const struct armstep_tables *tables = arm->tables;
    const step_memory_ArmPlan *plan = plan_of(arm);
    if (reader->is_bad || reader->number != reader->last_number || reader->integer != reader->last_integer) {
        return false;
    }
    if (!@arm_fits@plan, ARMSTEP_PART_schemes_collisions_collision_rows, ARMSTEP_PART_schemes_separation_separation_rows, ARMSTEP_PART_schemes_torque_torque_rows)
        || is_shield(arm) != (plan->request >= 0) || plan->sizes.obstacles != tables->obstacles
        || plan->sizes.n != tables->joints || plan->step.arrays.sizes.frames != tables->frames
        || plan->settings.at->dt != tables->dt || plan->settings.at->longest != tables->longest
        || !knows_parts(tables)) {
        return false;
    }
    const int64_t memory = @width@;
    return tables->memory == STATE + memory && tables->scratch == STATE + memory + @arm_scratch@plan);
}

enum armstep_status armstep_load(struct armstep *arm, const struct armstep_tables *tables)
{
    struct layout *own = (struct layout *)(void *)arm->laid_out;
    struct reader reader = {
        tables->numbers, tables->numbers + tables->number_count,
        tables->integers, tables->integers + tables->integer_count, false,
    };
    memset(arm, 0, sizeof *arm);
    arm->tables = tables;
    if (tables->release != ARMSTEP_RELEASE) {
        return ARMSTEP_OTHER_RELEASE;
    }
    if (!computes_as_ieee()) {
        return ARMSTEP_ARITHMETIC;
    }
    if (armstep_digest(tables) != tables->digest) {
        return ARMSTEP_DAMAGED;
    }
    own->plan = read_step_memory_ArmPlan(&reader);
    own->places = read_doubles(&reader, 3 * own->plan.sizes.obstacles);
    return is_laid_out(arm, &reader) ? ARMSTEP_OK : ARMSTEP_UNFIT;
}

void armstep_begin(const struct armstep *arm, double *memory, double *scratch)
{
    memset(memory, 0, sizeof *memory * (size_t)arm->tables->memory);
    memory[0] = mark_of(arm);
    (void)armstep_place(arm, memory, ((const struct layout *)(const void *)arm->laid_out)->places);
    (void)armstep_rest(arm, memory, scratch, NULL);
}

enum armstep_status armstep_rest(const struct armstep *arm, double *memory, double *scratch, const double *q)
{
    struct arena own_arena = arena_of(arm, scratch);
    struct arena *const arena = &own_arena;
    (void)arena;
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    const Vector joints = view_if_any(q, arm->tables->joints);
    if (!@all_finite@joints, 0, joints.size0)) {
        return ARMSTEP_NOT_FINITE;
    }
    @rest_arm@plan_of(arm), numbers_of(arm, memory), joints);
    return ARMSTEP_OK;
}

enum armstep_status armstep_halt(const struct armstep *arm, double *memory)
{
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    @halt_arm@plan_of(arm), numbers_of(arm, memory));
    return ARMSTEP_OK;
}

enum armstep_status armstep_scale_speed(const struct armstep *arm, double *memory, double scale)
{
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    return @scale_speed@plan_of(arm), numbers_of(arm, memory), scale) ? ARMSTEP_OK : ARMSTEP_NOT_FINITE;
}

enum armstep_status armstep_send(
    const struct armstep *arm, double *memory, const double *dq, double period, double fraction
)
{
    const Vector sent = view(dq, arm->tables->joints);
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    for (ptrdiff_t i = 0; i < sent.size0; i++) {
        if (!(fabs(dq[i]) <= ARMSTEP_FASTEST)) {
            return ARMSTEP_NOT_FINITE;
        }
    }
    if (!(period > 0.0 && period <= ARMSTEP_LONGEST) || !(fraction >= 0.0 && fraction <= 1.0)) {
        return ARMSTEP_NOT_FINITE;
    }
    @send_arm@plan_of(arm), numbers_of(arm, memory), sent, period, fraction);
    return ARMSTEP_OK;
}

enum armstep_status armstep_place(const struct armstep *arm, double *memory, const double *centers)
{
    const Vector numbers = view(centers, 3 * arm->tables->obstacles);
    const Matrix places = {numbers.data, arm->tables->obstacles, 3};
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    @place_arm@plan_of(arm), numbers_of(arm, memory), places);
    return @all_finite@numbers, 0, numbers.size0) ? ARMSTEP_OK : ARMSTEP_NOT_FINITE;
}

enum armstep_status armstep_follow(
    const struct armstep *arm, double *memory, const double *times, const double *positions, ptrdiff_t count, int mode
)
{
    const ptrdiff_t joints = arm->tables->joints;
    if (!is_shield(arm)) {
        return ARMSTEP_WRONG_KIND;
    }
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    if (count < 1 || count > @largest@) {
        return ARMSTEP_NOT_FINITE;
    }
    const Matrix rows = {view(positions, count * joints).data, count, joints};
    return @follow_arm@plan_of(arm), numbers_of(arm, memory), view(times, count), rows, mode) ? ARMSTEP_OK
                                                                                              : ARMSTEP_NOT_FINITE;
}

enum armstep_status armstep_people(
    const struct armstep *arm, double *memory, const double capsules[][7], ptrdiff_t count, double age
)
{
    /* Without capsules the frame of nobody has none; a count below 0 is above all that a frame may show. */
    const bool is_frame = count == 0 || (count > 0 && capsules != NULL);
    const Matrix own = {view_if_any(capsules != NULL ? capsules[0] : NULL, 0).data, is_frame ? count : PTRDIFF_MAX, 7};
    if (plan_of(arm)->sizes.bodies == 0) {
        return ARMSTEP_WRONG_KIND;
    }
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    return @see_people@plan_of(arm), numbers_of(arm, memory), own, age) ? ARMSTEP_OK : ARMSTEP_NOT_FINITE;
}

enum armstep_status armstep_body(
    const struct armstep *arm, double *memory, ptrdiff_t number, const double *box, double age
)
{
    if (number < 0 || number >= plan_of(arm)->sizes.bodies) {
        return ARMSTEP_WRONG_KIND;
    }
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    return @see_body@plan_of(arm), numbers_of(arm, memory), number, view(box, 15), age) ? ARMSTEP_OK
                                                                                           : ARMSTEP_NOT_FINITE;
}

static int64_t step(const struct armstep *arm, struct arena *arena, double *memory, const struct armstep_input *input)
{
    const step_memory_ArmInput own = {
        view(input->q, arm->tables->joints),
        input->request != NULL && is_shield(arm) ? input->kind : ARMSTEP_REQUEST_NONE,
        view_if_any(input->request, request_width(arm, input->kind)),
        input->dt,
        input->elapsed,
        input->t,
    };
    return @step_arm@plan_of(arm), numbers_of(arm, memory), &own);
}

int armstep_step(
    const struct armstep *arm, double *memory, double *scratch, const struct armstep_input *input, double *dq
)
{
    const size_t bytes = sizeof *memory * (size_t)arm->tables->memory;
    const size_t width = sizeof *dq * (size_t)arm->tables->joints;
    const bool may_fail = arm->tables->own_count > 0; /* where a user's own part takes too much */
    struct arena arena = arena_of(arm, scratch);
    if (!has_begun(arm, memory)) {
        memset(dq, 0, width);
        return ARMSTEP_INVALID;
    }
    if (may_fail) {
        memcpy(scratch, memory, bytes);
        arena.start += bytes;
        arena.top = arena.start;
    }
    struct armstep_input own = *input;
    if (own.q == NULL) { /* positions that could not be read are none */
        for (ptrdiff_t i = 0; i < arm->tables->joints; i++) {
            dq[i] = NAN;
        }
        own.q = dq;
    }
    int64_t result = step(arm, &arena, memory, &own);
    if (arena.full) { /* the next command of the motion to rest */
        memcpy(memory, scratch, bytes);
        arena = arena_of(arm, scratch);
        result = ARMSTEP_INVALID;
        @brake_arm@plan_of(arm), numbers_of(arm, memory));
    }
    memcpy(dq, motion_state_of(arm, memory).last.data, width);
    return (int)result;
}

ptrdiff_t armstep_steps(
    const struct armstep *arm, const struct armstep_batch *batch, double *scratch, ptrdiff_t first, ptrdiff_t last
)
{
    const ptrdiff_t n = arm->tables->joints;
    const ptrdiff_t width = request_width(arm, batch->input.kind);
    ptrdiff_t refused = 0;
    for (ptrdiff_t k = first; k < last; k++) {
        double *const memory = batch->memory + k * batch->stride;
        struct armstep_input own = batch->input;
        own.q = own.q != NULL ? own.q + k * n : NULL;
        own.request = own.request != NULL && (batch->given == NULL || batch->given[k]) ? own.request + k * width : NULL;
        batch->reasons[k] = armstep_step(arm, memory, scratch, &own, batch->dq + k * n);
        refused += batch->reasons[k] == ARMSTEP_INVALID;
        memcpy(batch->next_q + k * n, armstep_next_q(arm, memory), sizeof(double) * (size_t)n);
        batch->clipped[k] = armstep_is_clipped(arm, memory);
    }
    return refused;
}

enum armstep_status armstep_targets(
    const struct armstep *arm, const double *memory, double *scratch, double t, double *targets
)
{
    const Matrix own = {targets, arm->tables->frames, ARMSTEP_TARGET};
    struct arena own_arena = arena_of(arm, scratch);
    struct arena *const arena = &own_arena;
    if (is_shield(arm) || plan_of(arm)->step.paths.table.size0 == 0) {
        return ARMSTEP_WRONG_KIND;
    }
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    const double lag = motion_state_of(arm, memory).at->path_lag;
    @sample_targets@&plan_of(arm)->step.paths, t - lag, arm->tables->dt, own);
    return ARMSTEP_OK;
}

enum armstep_status armstep_save(const struct armstep *arm, const double *memory, double *saved)
{
    const ptrdiff_t count = arm->tables->memory;
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    const uint64_t digest = digested_numbers(arm->tables->digest, memory, count);
    memcpy(saved, memory, sizeof *saved * (size_t)count);
    saved[count] = (double)(digest >> 32);
    saved[count + 1] = (double)(digest & 0xffffffffu);
    return ARMSTEP_OK;
}

enum armstep_status armstep_restore(const struct armstep *arm, double *memory, const double *saved)
{
    const ptrdiff_t count = arm->tables->memory;
    const uint64_t digest = digested_numbers(arm->tables->digest, saved, count);
    if (!has_begun(arm, saved)) {
        return ARMSTEP_OTHER_TABLES;
    }
    if (saved[count] != (double)(digest >> 32) || saved[count + 1] != (double)(digest & 0xffffffffu)) {
        return ARMSTEP_DAMAGED;
    }
    memcpy(memory, saved, sizeof *memory * (size_t)count);
    return ARMSTEP_OK;
}

const double *armstep_next_q(const struct armstep *arm, const double *memory)
{
    return state_of(arm, memory).positions.data;
}

bool armstep_is_clipped(const struct armstep *arm, const double *memory)
{
    return state_of(arm, memory).at->is_clipped != 0.0;
}

static bool is_among(int code, const int *codes, int count)
{
    for (int i = 0; i < count; i++) {
        if (codes[i] == code) {
            return true;
        }
    }
    return false;
}

/* Write the codes of limits: of each joint the lower and the upper bound of each kind, then the rows, which belong to
 * one pair of bodies, or by their kind to another from step to step. Limits of rates, which most often follow from
 * others, come last. */
static int limit_codes(const struct armstep *arm, Vector limiting, int reasons, int *codes)
{
    const schemes_program_ProgramSizes *sizes = &plan_of(arm)->step.arrays.sizes;
    const int first_row = (int)arm->tables->first_row;
    const int joints = (int)arm->tables->joints;
    const int sides = (first_row - reasons) / joints;
    int count = 0;
    for (int of_rates = 0; of_rates < 2; of_rates++) {
        for (int k = 0; k < (int)limiting.size0; k++) {
            const int kind = (int)limiting.data[k];
            const int size = kind > 0 ? kind : -kind;
            const int row = k - (int)sizes->n;
            const bool is_rate = k < joints && (size == @acceleration@ || size == @jerk@);
            int code = reasons + sides * k + 2 * size - 2 + (kind > 0);
            if (kind == 0 || is_rate != (of_rates == 1) || (k >= joints && row < 0)) {
                continue;
            }
            if (row >= 0) {
                code = first_row + (kind > 1 ? (int)sizes->m + kind - 2 : row);
            }
            if (code >= reasons && code < arm->tables->limits && !is_among(code, codes, count)) {
                codes[count++] = code;
            }
        }
    }
    return count;
}

int armstep_active_limits(const struct armstep *arm, const double *memory, int *codes)
{
    int count = 0;
    if (!has_begun(arm, memory)) {
        return 0;
    }
    const step_memory_ArmState state = state_of(arm, memory);
    if (is_shield(arm) && state.at->is_clipped == 0.0) {
        return 0;
    }
    for (int k = 0; k < (int)state.reasons.size0; k++) {
        if (state.reasons.data[k] != 0.0) {
            codes[count++] = k;
        }
    }
    return count + limit_codes(arm, state.limiting, (int)state.reasons.size0, codes + count);
}

enum armstep_status armstep_margin(
    const struct armstep *arm, const double *memory, double *scratch, double *joint, double *distance
)
{
    struct arena own_arena = arena_of(arm, scratch);
    struct arena *const arena = &own_arena;
    if (!is_shield(arm)) {
        return ARMSTEP_WRONG_KIND;
    }
    if (!has_begun(arm, memory)) {
        return ARMSTEP_OTHER_TABLES;
    }
    const double_2 found = @margin_of@plan_of(arm), numbers_of(arm, memory));
    *joint = found.at[0];
    *distance = found.at[1];
    return ARMSTEP_OK;
}

double armstep_time(const struct armstep *arm, const double *memory)
{
    return state_of(arm, memory).at->time;
}

const double *armstep_followed(const struct armstep *arm, const double *memory, double *late)
{
    const step_memory_ArmState state = state_of(arm, memory);
    if (state.following.size0 == 0) {
        return NULL;
    }
    const step_samples_FollowState own = @follow_of@plan_of(arm), &state);
    if (own.at->count == 0.0) {
        return NULL;
    }
    *late = own.at->late;
    return own.reference.data;
}

enum armstep_status armstep_frame(
    const struct armstep *arm, double *scratch, const double *q, double *placement, double *jacobian
)
{
    struct arena own_arena = arena_of(arm, scratch);
    struct arena *const arena = &own_arena;
    const Vector joints = view(q, arm->tables->joints);
    (void)arena;
    if (!is_shield(arm)) {
        return ARMSTEP_WRONG_KIND;
    }
    if (!@all_finite@joints, 0, joints.size0)) {
        return ARMSTEP_NOT_FINITE;
    }
    const Matrix rows = {jacobian, 6, joints.size0};
    @frame_at@plan_of(arm), joints, view(placement, 12), rows);
    return ARMSTEP_OK;
}

double armstep_separation(const struct armstep *arm, const double *memory, double *scratch)
{
    struct arena own_arena = arena_of(arm, scratch);
    struct arena *const arena = &own_arena;
    (void)arena;
    if (!has_begun(arm, memory)) {
        return NAN;
    }
    return @separation_of@plan_of(arm), numbers_of(arm, memory)).at[0];
}

double armstep_torque(const struct armstep *arm, const double *memory, double *scratch)
{
    struct arena own_arena = arena_of(arm, scratch);
    struct arena *const arena = &own_arena;
    (void)arena;
    if (!has_begun(arm, memory)) {
        return NAN;
    }
    return @torque_of@plan_of(arm), numbers_of(arm, memory));
}

double armstep_stopping_time(const struct armstep *arm, const double *memory, double *scratch)
{
    struct arena own_arena = arena_of(arm, scratch);
    struct arena *const arena = &own_arena;
    (void)arena;
    return is_shield(arm) && has_begun(arm, memory) ? @stopping_time_of@plan_of(arm), numbers_of(arm, memory)) : NAN;
}

enum armstep_program armstep_program_of(const struct armstep *arm, const double *memory)
{
    return (enum armstep_program)(has_begun(arm, memory) ? (int)state_of(arm, memory).at->program : 0);
}

double armstep_fraction(const struct armstep *arm, const double *memory)
{
    return state_of(arm, memory).at->fraction;
}

double armstep_path_lag(const struct armstep *arm, const double *memory)
{
    return motion_state_of(arm, memory).at->path_lag;
}

const char *armstep_limit_name(const struct armstep_tables *tables, int code)
{
    return code >= 0 && code < tables->limits ? tables->limit_names[code] : "";
}

const char *armstep_action_name(int action)
{
    static const char *const names[] = {@action_names@};
    return action >= 0 && action < @action_count@ ? names[action] : "invalid";
}
