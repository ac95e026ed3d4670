!> The reference of the driver's bars: the rate equations of the spring-slider with the subloading
!> law (docs/theory.md, sections 1 and 7) by the explicit Runge-Kutta method 5(4) of Dormand and
!> Prince (J. Comput. Appl. Math. 6, 1980) with error control.
!>
!> Unknowns are the extension of the drive spring, the velocity of the block, the elastic
!> displacement of the contact and the friction coefficient; R follows from the traction.
module explicit_slider
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use run_settings, only : settings
    use slip_events, only : event_finder, moment, slip_event, turning_point
    implicit none
    private

    public :: explicit_run, solve_explicitly

    type :: explicit_run
        integer :: steps = 0, rejected = 0
        real(dp) :: seconds = 0.0_dp           !! CPU time
        real(dp) :: peak_force = 0.0_dp        !! of the last event [F]
        real(dp), allocatable :: onsets(:)     !! of the events [T]
    end type explicit_run

    integer, parameter :: stages = 7, unknowns = 4
    integer, parameter :: extension = 1, velocity = 2, elastic = 3, mu = 4

    !> Constants of the equations.
    type :: constants
        real(dp) :: mass, stiffness, damping, area, drive, pressure   !! as in `settings`
        real(dp) :: alpha_t, mu_s, mu_k, kappa, xi, m                 !! as in `props`
    end type constants

    real(dp), parameter :: a(stages, stages) = reshape([ &
        0.0_dp, 1.0_dp / 5, 3.0_dp / 40, 44.0_dp / 45, 19372.0_dp / 6561, 9017.0_dp / 3168, &
        35.0_dp / 384, &
        0.0_dp, 0.0_dp, 9.0_dp / 40, -56.0_dp / 15, -25360.0_dp / 2187, -355.0_dp / 33, 0.0_dp, &
        0.0_dp, 0.0_dp, 0.0_dp, 32.0_dp / 9, 64448.0_dp / 6561, 46732.0_dp / 5247, &
        500.0_dp / 1113, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, -212.0_dp / 729, 49.0_dp / 176, 125.0_dp / 192, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, -5103.0_dp / 18656, -2187.0_dp / 6784, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 11.0_dp / 84, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp], [stages, stages])
    !> Fifth order less fourth.
    real(dp), parameter :: e(stages) = [71.0_dp / 57600, 0.0_dp, -71.0_dp / 16695, &
        71.0_dp / 1920, -17253.0_dp / 339200, 22.0_dp / 525, -1.0_dp / 40]

contains

    !> Steps so short that the error in each is `rtol` of the unknowns' natural scales.
    subroutine solve_explicitly(run, rtol, smallest_drop, result)
        type(settings), intent(in) :: run
        real(dp), intent(in) :: rtol             !! [-]
        real(dp), intent(in) :: smallest_drop    !! fall of the force that is an event [F]
        type(explicit_run), intent(out) :: result
        type(constants) :: c
        type(event_finder) :: finder
        type(slip_event), allocatable :: events(:)
        type(moment) :: before, now, turn
        real(dp) :: y(unknowns), y_new(unknowns), k(unknowns, stages), tolerated(unknowns)
        real(dp) :: t, dt, error, highest, begun, ended
        integer :: i
        logical :: found

        call cpu_time(begun)
        c = constants(run%mass, run%stiffness, run%damping, run%area, run%drive%velocity(1), &
            run%drive%normal(1), run%props(3), run%props(4), run%props(5), run%props(6), &
            run%props(7), run%props(8))
        finder%drop = smallest_drop
        finder%stiffness = c%stiffness
        call finder%give_sense(1, c%drive)
        allocate (result%onsets(0), events(0))
        y = [0.0_dp, 0.0_dp, 0.0_dp, run%props(9)]
        associate (force => c%area * c%mu_s * c%pressure)
            tolerated = rtol * [force / c%stiffness, force / sqrt(c%stiffness * c%mass), &
                c%mu_s * c%pressure / c%alpha_t, c%mu_s]
        end associate
        t = 0.0_dp
        highest = 0.0_dp
        dt = 1.0e-6_dp
        k(:, 1) = rates(c, y)
        before = seen(c, t, y)
        do while (t < run%t_end)
            dt = min(dt, run%t_end - t)
            do i = 2, stages
                y_new = y + dt * matmul(k(:, :i - 1), a(i, :i - 1))
                k(:, i) = rates(c, y_new)
            end do
            error = maxval(abs(dt * matmul(k, e)) / tolerated)
            if (error <= 1.0_dp) then
                t = t + dt
                y = y_new
                k(:, 1) = k(:, stages)   ! the last stage is the next step's first
                result%steps = result%steps + 1
                now = seen(c, t, y)
                call turning_point(before, now, turn, found)
                if (found) highest = max(highest, turn%force)
                highest = max(highest, now%force)
                call finder%follow(before, now, .false., events)
                if (size(events) > 0) then
                    result%onsets = [result%onsets, events%onset]
                    result%peak_force = highest
                    highest = now%force
                    events = events(:0)
                end if
                before = now
            else
                result%rejected = result%rejected + 1
            end if
            dt = dt * min(5.0_dp, max(0.2_dp, 0.9_dp * max(error, 1.0e-10_dp)**(-0.2_dp)))
        end do
        call cpu_time(ended)
        result%seconds = ended - begun
    end subroutine solve_explicitly

    !> Time derivatives of the unknowns.
    pure function rates(c, y) result(dy)
        type(constants), intent(in) :: c
        real(dp), intent(in) :: y(unknowns)
        real(dp) :: dy(unknowns)
        real(dp) :: force, full, r, healing, slip_rate

        force = c%alpha_t * abs(y(elastic))
        full = y(mu) * c%pressure
        r = min(force / full, 1.0_dp)
        healing = c%xi * (c%mu_s - y(mu))
        slip_rate = 0.0_dp
        ! consistency: the traction stays on the subloading surface
        if (r > 0.0_dp) slip_rate = max(0.0_dp, (c%alpha_t * sign(y(velocity), y(velocity) &
            * y(elastic)) - c%pressure * r * healing) / (c%alpha_t - c%m * log(r) * full &
            - c%pressure * r * c%kappa * (y(mu) - c%mu_k)))
        dy(extension) = c%drive - y(velocity)
        dy(velocity) = (c%stiffness * y(extension) - c%damping * y(velocity) &
            - c%area * c%alpha_t * y(elastic)) / c%mass
        dy(elastic) = y(velocity) - sign(slip_rate, y(elastic))
        dy(mu) = healing - c%kappa * (y(mu) - c%mu_k) * slip_rate
    end function rates

    pure function seen(c, t, y) result(now)
        type(constants), intent(in) :: c
        real(dp), intent(in) :: t
        real(dp), intent(in) :: y(unknowns)
        type(moment) :: now

        now%time = t
        now%force = c%stiffness * y(extension)
        now%velocity = y(velocity)
        now%rate = c%stiffness * (c%drive - y(velocity))
        now%drive = c%drive * t
        now%slip = now%drive - y(extension) - y(elastic)
    end function seen

end module explicit_slider
