!> Chooses the steps in time, and repeats those that fail.
!>
!> Adaptive steps are taken twice, as a whole and in two halves. What separates the two estimates
!> the error; where the step resolves the fastest oscillation, it also takes the leading term of the
!> error away (Richardson extrapolation).
module step_control
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use chain_parts, only : parted_chain
    use friction_mod, only : friction_no_convergence, statev_dissipation, statev_mu, statev_r, &
        statev_slip, statev_status
    use law_input, only : is_subloading, typical_coefficient
    use loading_programme, only : programme
    use run_settings, only : settings
    use slider_system, only : apply_normal_traction, copy_state, set_accelerations, slider, &
        slider_state
    use time_integrator, only : generalised_alpha, newmark, step_report
    implicit none
    private

    public :: stepper

    type :: stepper
        type(slider) :: system
        type(newmark) :: method
        type(parted_chain), private :: blocks   !! takes its steps with several blocks
        type(programme) :: drive
        real(dp) :: origin = 0.0_dp    !! of the drive: its position at time 0 [L]
        real(dp) :: t_end = 0.0_dp     !! [T]
        logical :: adaptive = .false.
        real(dp) :: dt = 0.0_dp        !! fixed, or next to try [T]
        integer :: passed = 0          !! fixed steps behind us
        integer :: parts = 1           !! pieces that the fixed step is being taken in
        integer :: rejected = 0        !! steps that were tried in vain
        integer :: iterations = 0, most_iterations = 0   !! of Newton's method, the latter in a step
        ! of adaptive steps alone
        real(dp) :: dt_min = 0.0_dp, dt_max = 0.0_dp   !! [T]
        real(dp) :: tolerated = 0.0_dp     !! error in a step, as a spring force [F]
        real(dp) :: pressing = 0.0_dp      !! largest normal force [F]
        integer :: order = 1               !! of the method, with the friction law in it
        real(dp) :: stiffness = 0.0_dp     !! against displacements in the last step [F/L]
        real(dp) :: last_error = 1.0_dp    !! of the step before, part of the tolerated one
        type(slider_state) :: middle       !! half-way through the last step
        type(slider_state), private :: halves, whole   !! the end of it, by two steps and by one
    contains
        procedure :: begin, take_step, finished
        procedure, private :: take_fixed_step, take_adaptive_step, try, try_twice, error_of, &
            extrapolate, reversal, opening
    end type stepper

    integer, parameter :: most_parts = 2**20   !! of a fixed step

contains

    subroutine begin(self, run, system, start)
        class(stepper), intent(out) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start   !! the state at time 0

        self%system = system
        self%drive = run%drive
        self%origin = start%drive
        self%dt = run%dt
        self%t_end = run%t_end
        self%adaptive = run%adaptive
        self%method%beta = run%beta
        self%method%gamma = run%gamma
        self%method%tolerance = run%tolerance
        self%method%max_iterations = run%max_iterations
        if (run%rho_infinity >= 0.0_dp) self%method = generalised_alpha(run%rho_infinity, &
            run%tolerance, run%max_iterations)
        if (.not. run%adaptive) return
        self%dt_min = run%dt_min
        self%dt_max = run%dt_max
        self%order = run%order
        self%pressing = run%area * run%drive%largest_normal()
        self%tolerated = run%rtol * max(typical_coefficient(run%props) * self%pressing, &
            tiny(1.0_dp) / epsilon(1.0_dp))
        self%middle = start
        self%halves = start
        self%whole = start
    end subroutine begin

    pure function finished(self, state) result(yes)
        class(stepper), intent(in) :: self
        type(slider_state), intent(in) :: state
        logical :: yes

        yes = state%time >= self%t_end
    end function finished

    !> The next step.
    subroutine take_step(self, old, new, report, complete)
        class(stepper), intent(inout) :: self
        type(slider_state), intent(inout) :: old   !! a jump of the normal traction changes it
        type(slider_state), intent(inout) :: new   !! allocated like `old`
        type(step_report), intent(out) :: report
        logical, intent(out) :: complete   !! not a part of a fixed step

        complete = .true.
        if (self%adaptive) then
            call self%take_adaptive_step(old, new, report)
        else
            call self%take_fixed_step(old, new, report, complete)
        end if
    end subroutine take_step

    !> One step from `old` to `time`, in one piece of the programme.
    subroutine try(self, old, time, piece, new, report, guess)
        class(stepper), intent(inout) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: time   !! [T]
        integer, intent(in) :: piece
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)   !! of the displacements [L]

        if (size(old%x) > 1) then
            call self%blocks%step(self%method, self%system, self%origin &
                + self%drive%position(time), self%drive%normal_traction(time, piece), &
                time - old%time, old, new, report, guess)
        else
            call self%method%step(self%system, self%origin + self%drive%position(time), &
                self%drive%normal_traction(time, piece), time - old%time, old, new, report, guess)
        end if
        new%time = time
        self%iterations = self%iterations + report%iterations
        self%most_iterations = max(self%most_iterations, report%iterations)
    end subroutine try

    ! ---- fixed steps -------------------------------------------------------------------------

    !> With a mass the step is the fixed one; without, a step that fails is taken in parts, because
    !> the balance of forces may be followed in small steps where it cannot be found in a large one.
    subroutine take_fixed_step(self, old, new, report, complete)
        class(stepper), intent(inout) :: self
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        logical, intent(out) :: complete
        real(dp), parameter :: round_off = 1.0e-9_dp
        real(dp) :: aim, time

        aim = (self%passed + 1) * self%dt
        if (aim > self%t_end * (1.0_dp - round_off)) aim = self%t_end
        do
            complete = self%parts == 1
            time = aim
            if (.not. complete) time = old%time + (aim - old%time) / self%parts
            call self%try(old, time, self%drive%piece(time), new, report)
            if (report%status >= 0 .or. self%system%mass > 0.0_dp) exit
            if (2 * self%parts > most_parts) exit
            self%parts = 2 * self%parts
            self%rejected = self%rejected + 1
        end do
        if (report%status < 0) return
        if (complete) then
            self%passed = self%passed + 1
        else
            self%parts = self%parts - 1
            if (mod(self%parts, 2) == 0) self%parts = self%parts / 2
        end if
    end subroutine take_fixed_step

    ! ---- adaptive steps ----------------------------------------------------------------------

    subroutine take_adaptive_step(self, old, new, report)
        class(stepper), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), parameter :: safety = 0.9_dp, most_growth = 4.0_dp, most_cut = 0.2_dp
        real(dp) :: limit, end, dt, error, power, event
        integer :: piece
        logical :: cut

        power = 1.0_dp / (self%order + 1)
        piece = self%drive%piece(old%time)
        limit = min(self%drive%next_start(old%time), self%t_end)
        call apply_normal_traction(self%system, self%drive%normal_traction(old%time, piece), old)
        cut = .false.
        do
            end = end_of_step(old%time, self%dt, limit)
            dt = end - old%time
            call self%try_twice(old, end, piece, report)
            self%stiffness = max(self%system%stiffness, report%stiffness)
            if (report%status >= 0) then
                error = self%error_of()
                if (error <= 1.0_dp) then
                    event = self%opening(old, end, piece)
                    if (.not. cut) event = min(event, self%reversal(old))
                    if (event >= end .or. event - old%time <= 1.0e-3_dp * dt) exit
                    cut = .true.
                    self%dt = event - old%time
                    cycle
                end if
                self%dt = dt * max(most_cut, safety * error**(-power))
            else
                self%dt = 0.25_dp * dt
            end if
            self%rejected = self%rejected + 1
            if (self%dt < self%dt_min) then
                if (report%status >= 0) report%status = friction_no_convergence
                return
            end if
        end do
        error = max(error, 1.0e-4_dp)
        self%dt = min(self%dt_max, dt * min(most_growth, safety * error**(-0.7_dp * power) &
            * self%last_error**(0.4_dp * power)))
        self%last_error = error
        call self%extrapolate(dt, new)
    end subroutine take_adaptive_step

    !> No step is left that is much shorter than the one before the limit.
    pure function end_of_step(start, dt, limit) result(end)
        real(dp), intent(in) :: start, dt, limit   !! [T]
        real(dp) :: end                            !! [T]

        end = start + dt
        if (end >= limit - 1.0e-3_dp * dt) then
            end = limit
        else if (end > limit - dt) then
            end = start + 0.5_dp * (limit - start)
        end if
    end function end_of_step

    !> In two steps and in one; the ends are left in `halves` and `whole`.
    subroutine try_twice(self, old, end, piece, report)
        class(stepper), intent(inout) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: end         !! [T]
        integer, intent(in) :: piece
        type(step_report), intent(out) :: report

        call self%try(old, old%time + 0.5_dp * (end - old%time), piece, self%middle, report)
        if (report%status < 0) return
        call self%try(self%middle, end, piece, self%halves, report)
        if (report%status < 0) return
        call self%try(old, end, piece, self%whole, report, guess=self%halves%x)
    end subroutine try_twice

    !> Error of the two halves, part of the tolerated one: displacement and slip as the force that
    !> they mean to the spring, velocity by the amplitude that it becomes, friction coefficient by
    !> the force that it changes.
    pure function error_of(self) result(error)
        class(stepper), intent(in) :: self
        real(dp) :: error

        associate (a => self%halves, b => self%whole, s => self%system)
            error = maxval(max(s%stiffness * abs(a%x - b%x), &
                s%stiffness * sqrt(s%mass / self%stiffness) * abs(a%v - b%v), &
                s%stiffness * abs(a%statev(:, statev_slip) - b%statev(:, statev_slip)), &
                self%pressing * abs(a%statev(:, statev_mu) - b%statev(:, statev_mu))))
        end associate
        error = error / ((2**self%order - 1) * self%tolerated)
    end function error_of

    !> The better of what is known about the end of the step. Extrapolation would amplify an
    !> oscillation that is faster than the step, which takes a mass, and must not leave the range of
    !> the law's variables.
    subroutine extrapolate(self, dt, new)
        class(stepper), intent(inout) :: self
        real(dp), intent(in) :: dt          !! [T]
        type(slider_state), intent(inout) :: new
        real(dp) :: weight

        call copy_state(self%halves, new)
        if (self%system%mass > 0.0_dp .and. self%stiffness * dt**2 > self%system%mass) return
        weight = 1.0_dp / (2**self%order - 1)
        new%statev = new%statev + weight * (new%statev - self%whole%statev)
        new%statev(:, statev_status) = self%halves%statev(:, statev_status)
        associate (mu => new%statev(:, statev_mu), r => new%statev(:, statev_r))
            if (is_subloading(self%system%props)) then
                mu = min(self%system%props(4), max(self%system%props(5), mu))
                r = min(1.0_dp, max(0.0_dp, r))
            else
                mu = max(0.0_dp, mu)
                r = max(0.5_dp * self%halves%statev(:, statev_r), r)
            end if
        end associate
        new%statev(:, statev_slip) = max(0.0_dp, new%statev(:, statev_slip))
        new%statev(:, statev_dissipation) = max(0.0_dp, new%statev(:, statev_dissipation))
        new%x = new%x + weight * (new%x - self%whole%x)
        new%v = new%v + weight * (new%v - self%whole%v)
        new%spring = self%system%stiffness * (new%drive - new%x)
        new%friction = new%friction + weight * (new%friction - self%whole%friction)
        call set_accelerations(self%system, new)
    end subroutine extrapolate

    !> When the block turned round within the last step, if it stuck or slipped differently since:
    !> friction has a kink there.
    pure function reversal(self, old) result(time)
        class(stepper), intent(in) :: self
        type(slider_state), intent(in) :: old
        real(dp) :: time   !! [T]; huge without such a moment

        time = huge(time)
        associate (before => old%statev(:, statev_status), &
            after => self%halves%statev(:, statev_status))
            if (all(nint(before) == nint(after))) return
        end associate
        time = turn(old, self%middle)
        if (time <= self%middle%time) return
        time = turn(self%middle, self%halves)
    end function reversal

    !> When the velocity of the first block to do so changes its sign between two states, by cubic
    !> interpolation; huge if none does.
    pure function turn(a, b) result(time)
        type(slider_state), intent(in) :: a, b
        real(dp) :: time   !! [T]
        real(dp) :: dt, low, high, s
        integer :: i, k

        time = huge(time)
        dt = b%time - a%time
        do i = 1, size(a%x)
            if (a%v(i) * b%v(i) >= 0.0_dp) cycle
            low = 0.0_dp
            high = 1.0_dp
            do k = 1, 30
                s = 0.5_dp * (low + high)
                if ((a%v(i) * (1.0_dp + 2.0_dp * s) + dt * a%a(i) * s) * (1.0_dp - s)**2 * a%v(i) &
                    + (b%v(i) * (3.0_dp - 2.0_dp * s) - dt * b%a(i) * (1.0_dp - s)) * s**2 &
                    * a%v(i) > 0.0_dp) then
                    low = s
                else
                    high = s
                end if
            end do
            time = min(time, a%time + s * dt)
        end do
    end function turn

    !> When the normal traction vanishes, or comes back, within a step; huge if neither.
    pure function opening(self, old, end, piece) result(time)
        class(stepper), intent(in) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: end       !! of the step [T]
        integer, intent(in) :: piece
        real(dp) :: time                  !! [T]
        real(dp) :: low, high
        logical :: open_before
        integer :: k

        time = huge(time)
        open_before = old%normal <= 0.0_dp
        if (open_before .eqv. self%halves%normal <= 0.0_dp) return
        low = old%time
        high = end
        do k = 1, 52
            time = 0.5_dp * (low + high)
            if ((self%drive%normal_traction(time, piece) <= 0.0_dp) .eqv. open_before) then
                low = time
            else
                high = time
            end if
        end do
    end function opening

end module step_control
