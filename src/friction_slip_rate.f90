!> Slip rates of many points without a contact spring (public name and arguments: module
!> friction_mod).
!>
!> Points are taken in blocks, shared out among threads. A vector kernel takes whole blocks; the
!> points that it leaves go one by one. Each point is treated by itself: its result depends neither
!> on its neighbours nor on the number of threads.
submodule(friction_mod) friction_slip_rate
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t
    use friction_lane_block, only : lanes
    use friction_law_choice, only : find_rate_law, first_own_prop, law_storage, &
        option_orthotropy, options_of, prop_law, surface_options, whole_number
    use friction_rate_state_core, only : ageing_rate, asinh_exp, slip_law_rate, slope_asinh_exp, &
        state_exponent
    use friction_rate_state_law, only : ageing, n_constants, n_needed, rate_state_law, shifted, &
        slipping
    use friction_threads, only : worth_threads
    implicit none

    integer, parameter :: own_constants = n_needed   !! of the law: a, b, d_c, v0, f0
    integer, parameter :: few = 16 * lanes    !! points that are not worth a second thread
    integer, parameter :: least_props = first_own_prop + own_constants - 1
    integer, parameter :: prop_evolution = least_props + 1          !! may be left out
    integer, parameter :: first_option = first_own_prop + n_constants
    integer, parameter :: prop_theta_0 = prop_evolution + 1         !! likewise
    integer, parameter :: prop_ratio = first_option - 1 + option_orthotropy   !! 1 is as 0
    !> Values of `theta_0` that are judged without a second look.
    real(wp), parameter :: least_theta_0 = 1.0e-90_wp, most_theta_0 = 1.0e90_wp
    real(wp), parameter :: standstill = -700.0_wp      !! ln of what counts as no slip rate
    real(wp), parameter :: ln_most_rate = 300.0_wp     !! ln of the largest slip rate told
    real(wp), parameter :: least_scale = 1.0e-200_wp   !! of a p, so that quotients are in range

    interface
        !> See module friction_slip_rate_kernel.
        subroutine slip_rate_kernel(evolution, damping, stride, tau, pressure, theta, constants, &
            rates, left) bind(C, name='stickslip_slip_rate_kernel')
            import :: c_double, c_int, c_int64_t, lanes
            implicit none
            integer(c_int), value, intent(in) :: evolution
            real(c_double), value, intent(in) :: damping
            integer(c_int64_t), value, intent(in) :: stride
            real(c_double), intent(in) :: tau(lanes), pressure(lanes), theta(lanes)
            real(c_double), intent(in) :: constants(stride, *)
            real(c_double), intent(out) :: rates(lanes, 2)
            integer(c_int), intent(out) :: left(lanes)
        end subroutine slip_rate_kernel
    end interface

contains

    module subroutine friction_slip_rates(tau, pressure, damping, props, internal, rate, &
        internal_rate, status)
        real(wp), intent(in), contiguous :: tau(:), pressure(:), props(:, :), internal(:)
        real(wp), intent(in) :: damping
        real(wp), intent(inout), contiguous :: rate(:), internal_rate(:)
        integer, intent(out), contiguous :: status(:)
        integer(int64) :: n

        n = size(tau, 1, int64)
        status = friction_bad_size
        if (size(pressure, 1, int64) /= n .or. size(props, 1, int64) /= n &
            .or. size(internal, 1, int64) /= n .or. size(rate, 1, int64) /= n &
            .or. size(internal_rate, 1, int64) /= n .or. size(status, 1, int64) /= n) return
        call slip_rates_of_arrays(n, tau, pressure, damping, size(props, 2), props, internal, &
            rate, internal_rate, status)
    end subroutine friction_slip_rates

    module subroutine slip_rates_of_arrays(n, tau, pressure, damping, nprops, props, internal, &
        rate, internal_rate, status)
        integer(int64), intent(in) :: n
        integer, intent(in) :: nprops
        real(wp), intent(in) :: tau(n), pressure(n), damping, props(n, nprops), internal(n)
        real(wp), intent(inout) :: rate(n), internal_rate(n)
        integer, intent(out) :: status(n)
        logical :: vectors
        integer(int64) :: first

        if (nprops < least_props) then
            status = friction_bad_size
            return
        end if
        vectors = usual(damping)
        if (.not. worth_threads(n, few)) then
            do first = 1, n, lanes
                call rates_of_block(first)
            end do
        else
            !$omp parallel do schedule(static)
            do first = 1, n, lanes
                call rates_of_block(first)
            end do
            !$omp end parallel do
        end if

    contains

        subroutine rates_of_block(first)
            integer(int64), intent(in) :: first
            real(wp) :: rates(lanes, 2)
            integer(c_int) :: left(lanes)
            integer :: count, k

            count = int(min(int(lanes, int64), n - first + 1))
            left = 1
            if (vectors) call try_kernel(count, damping, n, tau(first), pressure(first), &
                internal(first), nprops, props(first, 1), rates, left)
            if (sum(left(:count)) == 0) then
                rate(first:first + count - 1) = rates(:count, 1)
                internal_rate(first:first + count - 1) = rates(:count, 2)
                status(first:first + count - 1) = friction_ok
                return
            end if
            do k = 1, count
                if (left(k) == 0) then
                    rate(first + k - 1) = rates(k, 1)
                    internal_rate(first + k - 1) = rates(k, 2)
                    status(first + k - 1) = friction_ok
                else
                    call rates_of_point(first + k - 1)
                end if
            end do
        end subroutine rates_of_block

        subroutine rates_of_point(i)
            integer(int64), intent(in) :: i
            real(wp) :: own_rates(2)

            call solve_point(tau(i), pressure(i), damping, props(i, :), internal(i), own_rates, &
                status(i))
            if (status(i) < 0) return
            rate(i) = own_rates(1)
            internal_rate(i) = own_rates(2)
        end subroutine rates_of_point

    end subroutine slip_rates_of_arrays

    !> No damping, or one of the size that the kernel takes?
    pure function usual(damping)
        real(wp), intent(in) :: damping
        logical :: usual
        real(wp), parameter :: least = 1.0e-30_wp, most = 1.0e30_wp

        usual = are_usable([damping])
        if (usual) usual = abs(damping) <= 0.0_wp .or. (damping >= least .and. damping <= most)
    end function usual

    pure subroutine copy_column(count, from, to)
        integer, intent(in) :: count
        real(wp), intent(in) :: from(count)
        real(wp), intent(out) :: to(lanes)

        to(:count) = from
        to(count + 1:) = from(1)
    end subroutine copy_column

    !> Rates of the points that the kernel takes: those of rate-and-state friction that evolve as
    !> the first one does, without shear cap and cohesion. The last block is filled up with copies
    !> of its first point.
    subroutine try_kernel(count, damping, n, tau, pressure, theta, nprops, props, rates, left)
        integer, intent(in) :: count                 !! points of the block
        real(wp), intent(in) :: damping
        integer(int64), intent(in) :: n              !! points of the arrays
        integer, intent(in) :: nprops
        real(wp), intent(in) :: tau(count), pressure(count), theta(count)
        real(wp), intent(in) :: props(n, nprops)     !! from the first point of the block on
        real(wp), intent(out) :: rates(lanes, 2)
        integer(c_int), intent(inout) :: left(lanes)   !! 1 for a point that is not taken
        real(wp) :: full(lanes, 3), constants(lanes, own_constants)
        integer :: evolution, i, k

        evolution = ageing
        if (nprops >= prop_evolution) then
            if (.not. are_usable([props(1, prop_evolution)])) return
            evolution = whole_number(props(1, prop_evolution))
            if (evolution /= ageing .and. evolution /= slipping) return
        end if
        if (count == lanes) then
            call slip_rate_kernel(evolution, damping, n, tau, pressure, theta, &
                props(1, first_own_prop), rates, left)
        else
            call copy_column(count, tau, full(:, 1))
            call copy_column(count, pressure, full(:, 2))
            call copy_column(count, theta, full(:, 3))
            do i = 1, own_constants
                call copy_column(count, props(1, first_own_prop + i - 1), constants(:, i))
            end do
            call slip_rate_kernel(evolution, damping, int(lanes, c_int64_t), full(:, 1), &
                full(:, 2), full(:, 3), constants, rates, left)
        end if
        do i = 1, count
            if (differs(props(i, prop_law), real(law_rate_state, wp))) left(i) = 1
        end do
        if (nprops >= prop_evolution) then
            do i = 1, count
                if (differs(props(i, prop_evolution), real(evolution, wp))) left(i) = 1
            end do
        end if
        if (nprops < prop_theta_0) return
        do i = 1, count   ! it is not used, but judged
            if (.not. is_between(props(i, prop_theta_0), least_theta_0, most_theta_0)) left(i) = 1
        end do
        do k = first_option, nprops
            do i = 1, count
                if (differs(props(i, k), 0.0_wp) .and. (k /= prop_ratio &
                    .or. differs(props(i, k), 1.0_wp))) left(i) = 1
            end do
        end do
    end subroutine try_kernel

    !> Compares bits of a positive number, as `differs` does.
    elemental function is_between(x, low, high)
        real(wp), intent(in) :: x, low, high
        logical :: is_between
        integer(int64) :: bits

        bits = transfer(x, 0_int64)
        is_between = bits >= transfer(low, 0_int64) .and. bits <= transfer(high, 0_int64)
    end function is_between

    !> Compares bits: silent where a comparison with NaN raises an exception.
    elemental function differs(x, y)
        real(wp), intent(in) :: x, y
        logical :: differs

        differs = transfer(x, 0_int64) /= transfer(y, 0_int64)
    end function differs

    !> Any point by itself: checks, and solves.
    pure subroutine solve_point(tau, pressure, damping, props, theta, rates, status)
        real(wp), intent(in) :: tau, pressure, damping, props(:), theta
        real(wp), intent(out) :: rates(2)   !! v, d(theta)/dt
        integer, intent(out) :: status
        type(law_storage), target :: storage
        class(rate_state_law), pointer :: surface
        type(surface_options) :: options
        real(wp) :: ln_v, ln_w, shift, by_ln_v
        integer :: n_own

        status = friction_bad_increment
        if (.not. are_usable([tau, pressure, damping])) return
        if (min(tau, pressure, damping) < 0.0_wp) return
        status = friction_bad_property
        if (.not. (are_usable([props(prop_law)]) .and. are_usable(props(first_own_prop:)))) return
        status = friction_bad_law
        nullify (surface)
        call find_rate_law(whole_number(props(prop_law)), storage, surface)
        if (.not. associated(surface)) return
        call surface%read(size(props) - first_own_prop + 1, props(first_own_prop:), n_own, status)
        if (status < 0) return
        options%tau_max = 0.0_wp
        options%cohesion = 0.0_wp
        if (size(props) >= first_own_prop + n_own) call options_of(size(props) - first_own_prop &
            - n_own + 1, props(first_own_prop + n_own:), options, status)
        if (status < 0) return
        status = friction_bad_state
        if (.not. are_usable([theta])) return
        if (.not. theta > 0.0_wp) return

        call solve_balance(max(tau - options%cohesion, 0.0_wp), pressure, damping, surface, theta, &
            ln_v, status)
        if (status < 0) return
        associate (cap => options%tau_max)
            if (cap > 0.0_wp .and. tau - damping * exp(ln_v) > cap) then
                ln_v = 2.0_wp * ln_most_rate   ! nothing but damping holds it
                if (damping > 0.0_wp) ln_v = log(tau - cap) - log(damping)
            end if
        end associate
        ln_w = ln_v + log(theta) - log(surface%d_c)
        status = friction_no_convergence
        if (max(ln_v, ln_w) > ln_most_rate) return
        status = friction_ok
        rates(1) = exp(ln_v)
        if (ln_v <= standstill) rates(1) = 0.0_wp
        if (surface%evolution == ageing) then
            rates(2) = ageing_rate(rates(1) * theta / surface%d_c)
        else
            shift = 0.0_wp
            if (surface%evolution == shifted) call surface%steady_shift(ln_v, shift, by_ln_v)
            rates(2) = slip_law_rate(rates(1) * theta / surface%d_c, ln_w - shift)
        end if
    end subroutine solve_point

    !> The slip rate, as a logarithm, by Newton's method on
    !>
    !>     g(L) = damping e^L/(a p) + asinh(e^(L - ln(2 v0) + x)) - t,   L = ln(v), t = tau/(a p)
    !>
    !> which grows and is convex: from where it is positive the method falls to the root. It starts
    !> from the lower of the slip rates that damping and friction alone allow. For a small t, which
    !> may be too small for the method, friction is linear in v.
    pure subroutine solve_balance(tau, pressure, damping, surface, theta, ln_v, status)
        real(wp), intent(in) :: tau, pressure, damping   !! >= 0
        class(rate_state_law), intent(in) :: surface
        real(wp), intent(in) :: theta                    !! > 0 [T]
        real(wp), intent(out) :: ln_v
        integer, intent(out) :: status                   !! ok or no convergence
        real(wp), parameter :: small = 1.0e-9_wp         !! the next error is below its square
        real(wp), parameter :: linear = 1.0e-9_wp        !! sinh(t) is t to the last bit
        real(wp), parameter :: nothing = 1.0e-40_wp      !! of tau, times any logarithm
        integer, parameter :: max_iterations = 200
        real(wp) :: scale, shift, t, damped, step
        logical :: is_linear
        integer :: iteration

        status = friction_ok
        ln_v = standstill
        if (.not. tau > 0.0_wp) return
        status = friction_no_convergence
        if (max(surface%a, surface%b, surface%f0) * pressure <= nothing * tau) then
            if (.not. damping > 0.0_wp) return   ! nothing holds it
            ln_v = log(tau) - log(damping)
            if (ln_v <= ln_most_rate) status = friction_ok
            return
        end if
        scale = max(surface%a * pressure, least_scale)
        t = tau / scale
        shift = state_exponent(surface%a, surface%b, surface%f0, log(surface%v0) + log(theta) &
            - log(surface%d_c)) - log(2.0_wp * surface%v0)
        is_linear = t < linear
        if (is_linear) then
            ln_v = log(tau) - log(scale) - shift
            if (damping > 0.0_wp) ln_v = ln_v - log_1_plus_exp(log(damping) - log(scale) - shift)
        else
            ln_v = log_sinh(t) - shift
            if (damping > 0.0_wp) ln_v = min(ln_v, log(tau) - log(damping))
        end if
        if (ln_v > ln_most_rate) return
        status = friction_ok
        ln_v = max(ln_v, standstill)
        if (is_linear .or. ln_v <= standstill .or. .not. damping > 0.0_wp) return
        do iteration = 1, max_iterations
            damped = exp(ln_v) * (damping / scale)
            step = (damped + asinh_exp(ln_v + shift) - t) &
                / (damped + slope_asinh_exp(ln_v + shift))
            ln_v = ln_v - step
            if (abs(step) <= small) return
        end do
        status = friction_no_convergence
    end subroutine solve_balance

    !> ln(1 + e^x).
    pure function log_1_plus_exp(x) result(y)
        real(wp), intent(in) :: x
        real(wp) :: y

        y = max(x, 0.0_wp) + log(1.0_wp + exp(-abs(x)))
    end function log_1_plus_exp

    !> ln(sinh(t)) for t > 0.
    pure function log_sinh(t) result(y)
        real(wp), intent(in) :: t
        real(wp) :: y

        if (t < 1.0_wp) then
            y = log(sinh(t))
        else
            y = t - log(2.0_wp) + log(1.0_wp - exp(-2.0_wp * t))
        end if
    end function log_sinh

end submodule friction_slip_rate
