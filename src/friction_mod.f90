!> Front door of the library: the friction routine with an FE-interface signature.
!>
!> Traction is what the contact transmits, positive in tension; component 1 is normal, then
!> tangential. See docs/theory.md for the model and docs/user_guide.md for the constants and state
!> variables. Every procedure here is pure: no saved data, no input or output, no allocation. On a
!> negative `status` nothing else is touched.
!>
!> The procedures themselves are in the submodules friction_advance, friction_batch,
!> friction_points and friction_slip_rate.
module friction_mod
    use, intrinsic :: iso_fortran_env, only : int64
    use friction_anisotropy, only : direction_associated, direction_radial, largest_mu_ratio
    use friction_kinds, only : wp
    use friction_law_choice, only : law_coulomb, law_flash_heating, law_linker_dieterich, &
        law_rate_state, law_slip_weakening, law_slip_weakening_healing, law_static_kinetic, &
        law_subloading, prop_alpha_n, prop_alpha_t, prop_law
    use friction_law_facts, only : broken_rule, constant_table, friction_check, &
        friction_coefficient_change, friction_constants, friction_default, friction_facts, &
        friction_healing_rate, friction_internal_variable, friction_law_count, friction_law_name, &
        friction_law_number, friction_law_of, friction_law_summary, friction_place, &
        internal_variable, law_constant, law_facts, rule_text, text_length, word_of
    use friction_status, only : friction_bad_axis, friction_bad_increment, friction_bad_law, &
        friction_bad_normal, friction_bad_property, friction_bad_size, friction_bad_state, &
        friction_message, friction_no_convergence, friction_null_pointer, friction_ok, &
        friction_no_rate, friction_snap_back, friction_zero_time_increment
    use friction_subloading_law, only : scheme_backward_euler, scheme_exact_rate, u_cotangent, &
        u_logarithm, u_reciprocal
    use friction_surface, only : law_state, law_traits, load_rates, onset_drops, onset_gradual, &
        onset_yields, read_surface, sliding_surface
    implicit none
    private

    public :: friction_update, friction_update_frame, friction_tangential, friction_update_batch, &
        friction_update_points, friction_rates, friction_slip_rates, friction_is_orthotropic, &
        friction_message, friction_version
    ! for the C interface
    public :: array_sizes, slip_rates_of_arrays, update_arrays, update_arrays_batch, &
        update_arrays_points
    public :: friction_bad_axis, friction_bad_increment, friction_bad_law, friction_bad_normal, &
        friction_bad_property, friction_bad_size, friction_bad_state, friction_no_convergence, &
        friction_no_rate, friction_null_pointer, friction_ok, friction_snap_back, &
        friction_zero_time_increment
    ! a law for those who integrate its rates themselves
    public :: law_state, law_traits, load_rates, read_surface, sliding_surface
    public :: onset_drops, onset_gradual, onset_yields
    ! what is to be known about the laws: module friction_law_facts
    public :: friction_check, friction_coefficient_change, friction_constants, friction_default, &
        friction_facts, friction_healing_rate, friction_internal_variable, friction_law_count, &
        friction_law_name, friction_law_number, friction_law_of, friction_law_summary, &
        friction_place, broken_rule, constant_table, internal_variable, law_constant, law_facts, &
        rule_text, text_length, word_of
    public :: prop_alpha_n, prop_alpha_t, prop_law   ! places in `props` that all laws share
    public :: law_coulomb, law_flash_heating, law_linker_dieterich, law_rate_state, &
        law_slip_weakening, law_slip_weakening_healing, law_static_kinetic, law_subloading
    public :: scheme_backward_euler, scheme_exact_rate
    public :: u_cotangent, u_logarithm, u_reciprocal
    public :: direction_associated, direction_radial, largest_mu_ratio

    character(len=*), parameter :: friction_version = '0.1.0'   !! semantic version of the library

    !> Places in `statev`.
    integer, parameter, public :: statev_size = 8          !! least size
    integer, parameter, public :: statev_status = 1        !! 0 virgin, 1 stick, 2 slip, 3 open
    integer, parameter, public :: statev_u_n = 2           !! normal relative displacement [L]
    integer, parameter, public :: statev_u_et = 3   !! first elastic tangential displacement [L]
    integer, parameter, public :: statev_mu = 5            !! friction coefficient [-]
    integer, parameter, public :: statev_r = 6   !! internal variable of the law, e.g. R
    integer, parameter, public :: statev_slip = 7          !! accumulated slip [L]
    integer, parameter, public :: statev_dissipation = 8   !! accumulated dissipated energy per
                                                           !! area [F/L]

    !> Sizes of the arrays of a caller that hands them over without descriptors.
    type :: array_sizes
        integer(int64) :: points   !! contact points, 0 or more; 1 where there is no batch
        integer :: ndir            !! components of du: 2 or 3
        integer :: nprops          !! material constants
        integer :: nstatv          !! state variables of a point
    end type array_sizes

    !> Many points at once, with the same constants or with their own.
    interface friction_update_batch
        module procedure update_batch_alike, update_batch_varied
    end interface friction_update_batch

    interface
        !> Friction update of a contact point in its own axes (docs/theory.md, sections 3 and 4).
        pure module subroutine friction_update(du, dtime, props, statev, traction, tangent, status)
            implicit none
            real(wp), intent(in), contiguous :: du(:)   !! increment of relative displacement:
                                                        !! normal, tangential 1[, 2]; size 2 or 3,
                                                        !! finite [L]
            real(wp), intent(in) :: dtime               !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants: number of the law,
                                                           !! alpha_n, alpha_t, its own
            real(wp), intent(inout), contiguous :: statev(:)   !! state, start in, end out; size 8
                                                               !! or more; all zero = virgin
            real(wp), intent(inout), contiguous :: traction(:)   !! T at the end of the increment;
                                                                 !! size of du [F/L^2]
            real(wp), intent(inout), contiguous :: tangent(:, :)   !! dT_i/d(du_j), unsymmetric;
                                                                   !! size of du squared [F/L^3]
            integer, intent(out) :: status   !! a named code; `friction_message` gives its text
        end subroutine friction_update

        !> `friction_update` with explicit sizes, as the C interface and Fortran 77 hand them over.
        pure module subroutine update_arrays(sizes, du, dtime, props, statev, traction, tangent, &
            status)
            implicit none
            type(array_sizes), intent(in) :: sizes
            real(wp), intent(in) :: du(sizes%ndir), dtime, props(sizes%nprops)
            real(wp), intent(inout) :: statev(sizes%nstatv), traction(sizes%ndir)
            real(wp), intent(inout) :: tangent(sizes%ndir, sizes%ndir)
            integer, intent(out) :: status
        end subroutine update_arrays

        !> The same in any orthonormal frame, given the unit normal (the paper's `I - n n` form).
        !>
        !> Here statev(2:) holds the vector `u_n n + u_et` in the caller's frame. A host that
        !> rotates the frame or the normal during an increment rotates these components as it
        !> rotates any vector of its own. Orthotropic friction in space needs its axis 1, too: the
        !> part of `axis` at right angles to the normal. Axis 2 is normal x axis 1.
        pure module subroutine friction_update_frame(du, normal, dtime, props, statev, traction, &
            tangent, status, axis)
            implicit none
            real(wp), intent(in), contiguous :: du(:)   !! increment of relative displacement, slave
                                                        !! seen from master; size 2 or 3, finite [L]
            real(wp), intent(in), contiguous :: normal(:)   !! unit normal from master to slave;
                                                            !! size of du [-]
            real(wp), intent(in) :: dtime             !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            real(wp), intent(inout), contiguous :: statev(:)   !! state, start in, end out; size 8
                                                               !! or more; all zero = virgin
            real(wp), intent(inout), contiguous :: traction(:)   !! T at the end of the increment;
                                                                 !! size of du [F/L^2]
            real(wp), intent(inout), contiguous :: tangent(:, :)   !! dT_i/d(du_j), unsymmetric;
                                                                   !! size of du squared [F/L^3]
            integer, intent(out) :: status            !! a named code; also `friction_bad_normal`,
                                                      !! `friction_bad_axis`
            real(wp), intent(in), contiguous, optional :: axis(:)   !! tangential axis 1, of any
                                                                    !! length; size of du; isotropic
                                                                    !! friction does not need it
        end subroutine friction_update_frame

        !> Do these constants tell one tangential axis from another?
        pure module function friction_is_orthotropic(props) result(orthotropic)
            implicit none
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            logical :: orthotropic             !! false also for constants that are refused
        end function friction_is_orthotropic

        !> Tangential part alone, for hosts that hand in the pressure.
        !>
        !> The normal spring is the host's; alpha_n only turns the pressure into the penetration
        !> kept in statev(2).
        pure module subroutine friction_tangential(du, pressure, dtime, props, statev, tau, &
            dtau_ddu, dtau_dp, status)
            implicit none
            real(wp), intent(in), contiguous :: du(:)   !! increment of tangential displacement;
                                                        !! size 1 or 2, finite [L]
            real(wp), intent(in) :: pressure   !! at the end of the increment; <= 0 is an open
                                               !! contact [F/L^2]
            real(wp), intent(in) :: dtime           !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            real(wp), intent(inout), contiguous :: statev(:)   !! state, start in, end out; size 8
                                                               !! or more; all zero = virgin
            real(wp), intent(inout), contiguous :: tau(:)   !! tangential traction, sign of the
                                                            !! slip; size of du [F/L^2]
            real(wp), intent(inout), contiguous :: dtau_ddu(:, :)   !! d(tau_i)/d(du_j); size of du
                                                                    !! squared [F/L^3]
            real(wp), intent(inout), contiguous :: dtau_dp(:)   !! d(tau)/d(pressure); size of du
                                                                !! [-]
            integer, intent(out) :: status   !! a named code; `friction_message` gives its text
        end subroutine friction_tangential

        !> Continuous time: the rates of a contact point's state for a relative velocity
        !> (docs/theory.md, section 10), to which the update tends as its increment of time tends to
        !> zero.
        pure module subroutine friction_rates(velocity, props, statev, rates, status)
            implicit none
            real(wp), intent(in), contiguous :: velocity(:)   !! relative, normal, tangential 1[,
                                                              !! 2]; size 2 or 3, finite [L/T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            real(wp), intent(in), contiguous :: statev(:)   !! state; size 8 or more; all zero =
                                                            !! virgin
            real(wp), intent(inout), contiguous :: rates(:)   !! rates of statev(2) to statev(8),
                                                              !! per unit of time; rates(1) = 0;
                                                              !! size 8 or more, of which 8 are set
            integer, intent(out) :: status        !! a named code; `friction_no_rate` where slip
                                                  !! starts with a jump
        end subroutine friction_rates

        !> For the other submodules: is every number finite and below 2**333 (1.7e100) in magnitude?
        pure module function are_usable(x) result(usable)
            implicit none
            real(wp), intent(in) :: x(:)
            logical :: usable
        end function are_usable

        !> Friction update of many contact points, all with the same increment of time and the same
        !> constants (docs/performance.md). Arrays are component-major: component j of point i is
        !> du(i, j). Bad input at a point leaves that point's data untouched and harms no other
        !> point.
        module subroutine update_batch_alike(du, dtime, props, statev, traction, tangent, status)
            implicit none
            real(wp), intent(in), contiguous :: du(:, :)   !! increments of relative displacement;
                                                           !! n points, 2 or 3 components [L]
            real(wp), intent(in) :: dtime                  !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            real(wp), intent(inout), contiguous :: statev(:, :)     !! states, start in, end out; n
                                                                    !! points, 8 or more
            real(wp), intent(inout), contiguous :: traction(:, :)   !! shape of du [F/L^2]
            real(wp), intent(inout), contiguous :: tangent(:, :, :)   !! dT_i/d(du_j) of point k is
                                                                      !! tangent(k, i, j) [F/L^3]
            integer, intent(out), contiguous :: status(:)   !! a named code for each of the n points
        end subroutine update_batch_alike

        !> The same with constants of its own at each point; the fast way is for points that share
        !> the law and its choices (scheme, u_of_r, evolution, direction).
        module subroutine update_batch_varied(du, dtime, props, statev, traction, tangent, status)
            implicit none
            real(wp), intent(in), contiguous :: du(:, :)   !! increments of relative displacement;
                                                           !! n points, 2 or 3 components [L]
            real(wp), intent(in) :: dtime                  !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:, :)   !! material constants; n points, as
                                                              !! in `friction_update`
            real(wp), intent(inout), contiguous :: statev(:, :)     !! states, start in, end out; n
                                                                    !! points, 8 or more
            real(wp), intent(inout), contiguous :: traction(:, :)   !! shape of du [F/L^2]
            real(wp), intent(inout), contiguous :: tangent(:, :, :)   !! dT_i/d(du_j) of point k is
                                                                      !! tangent(k, i, j) [F/L^3]
            integer, intent(out), contiguous :: status(:)   !! a named code for each of the n points
        end subroutine update_batch_varied

        !> Both with explicit sizes.
        module subroutine update_arrays_batch(sizes, du, dtime, rows, props, statev, traction, &
            tangent, status)
            implicit none
            type(array_sizes), intent(in) :: sizes
            real(wp), intent(in) :: du(sizes%points, sizes%ndir), dtime
            integer(int64), intent(in) :: rows   !! of `props`: 1, or one for each point
            real(wp), intent(in) :: props(rows, sizes%nprops)
            real(wp), intent(inout) :: statev(sizes%points, sizes%nstatv)
            real(wp), intent(inout) :: traction(sizes%points, sizes%ndir)
            real(wp), intent(inout), target :: tangent(sizes%points, sizes%ndir, sizes%ndir)
            integer, intent(out) :: status(sizes%points)
        end subroutine update_arrays_batch

        !> `friction_update_batch` for arrays that keep each point's numbers together, as C and
        !> numpy order them: component j of point i is du(j, i).
        module subroutine friction_update_points(du, dtime, props, statev, traction, tangent, &
            status)
            implicit none
            real(wp), intent(in), contiguous :: du(:, :)   !! increments of relative displacement; 2
                                                           !! or 3 components, n points [L]
            real(wp), intent(in) :: dtime                  !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            real(wp), intent(inout), contiguous :: statev(:, :)     !! states, start in, end out; 8
                                                                    !! or more, n points
            real(wp), intent(inout), contiguous :: traction(:, :)   !! shape of du [F/L^2]
            real(wp), intent(inout), contiguous :: tangent(:, :, :)   !! dT_i/d(du_j) of point k is
                                                                      !! tangent(j, i, k) [F/L^3]
            integer, intent(out), contiguous :: status(:)   !! a named code for each of the n points
        end subroutine friction_update_points

        !> The same with explicit sizes.
        module subroutine update_arrays_points(sizes, du, dtime, props, statev, traction, tangent, &
            status)
            implicit none
            type(array_sizes), intent(in) :: sizes
            real(wp), intent(in) :: du(sizes%ndir, sizes%points), dtime, props(sizes%nprops)
            real(wp), intent(inout) :: statev(sizes%nstatv, sizes%points)
            real(wp), intent(inout) :: traction(sizes%ndir, sizes%points)
            real(wp), intent(inout) :: tangent(sizes%ndir, sizes%ndir, sizes%points)   !! (j, i, k)
            integer, intent(out) :: status(sizes%points)
        end subroutine update_arrays_points

        !> Slip rates of many points without a contact spring: v >= 0 with
        !>
        !>     tau - damping v = friction(v, internal, pressure)
        !>
        !> and the rate of the law's internal variable at that v (docs/theory.md, section 11). For
        !> laws in which friction is a growing function of the slip rate, for a given internal
        !> variable: rate-and-state. Others get `friction_bad_law`, static-kinetic friction too: it
        !> falls with the slip rate, so that several v can balance one traction. Bad input at a
        !> point leaves its results untouched and harms no other point; `friction_no_convergence`
        !> tells a slip rate beyond the range of the arithmetic.
        module subroutine friction_slip_rates(tau, pressure, damping, props, internal, rate, &
            internal_rate, status)
            implicit none
            real(wp), intent(in), contiguous :: tau(:)   !! magnitudes of the tangential traction,
                                                         !! >= 0; n points [F/L^2]
            real(wp), intent(in), contiguous :: pressure(:)   !! >= 0, size n [F/L^2]
            real(wp), intent(in) :: damping                   !! radiation damping, >= 0 [F T/L^3]
            real(wp), intent(in), contiguous :: props(:, :)   !! constants of each point as in
                                                              !! `friction_update`, n x 8 or more;
                                                              !! the springs are not used
            real(wp), intent(in), contiguous :: internal(:)   !! theta, > 0, size n [T]
            real(wp), intent(inout), contiguous :: rate(:)    !! v, size n [L/T]
            real(wp), intent(inout), contiguous :: internal_rate(:)   !! d(theta)/dt, size n [-]
            integer, intent(out), contiguous :: status(:)   !! a named code for each of the n points
        end subroutine friction_slip_rates

        !> The same with explicit sizes.
        module subroutine slip_rates_of_arrays(n, tau, pressure, damping, nprops, props, internal, &
            rate, internal_rate, status)
            implicit none
            integer(int64), intent(in) :: n     !! points
            integer, intent(in) :: nprops       !! constants of a point
            real(wp), intent(in) :: tau(n), pressure(n), damping, props(n, nprops), internal(n)
            real(wp), intent(inout) :: rate(n), internal_rate(n)
            integer, intent(out) :: status(n)
        end subroutine slip_rates_of_arrays
    end interface

end module friction_mod
