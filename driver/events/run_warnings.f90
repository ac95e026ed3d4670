!> What a user should know about a run that came to its end: where its results may not be what the
!> model means (docs/driver.md, warnings).
module run_warnings
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_facts, law_facts, onset_drops, prop_alpha_t
    use law_facts, only : pressure_effect
    use run_outcome, only : outcome
    use run_settings, only : settings
    implicit none
    private

    public :: find_warnings, run_warning

    type :: run_warning
        character(len=16) :: code = ''     !! one word, for tables
        character(len=240) :: text = ''    !! one line
    end type run_warning

contains

    subroutine find_warnings(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(out) :: warnings(:)

        allocate (warnings(0))
        call look_at_energy(run, result, warnings)
        if (run%mass > 0.0_dp) then
            if (.not. run%adaptive) call look_at_step(run, result, warnings)
            call look_at_contact(run, result, warnings)
        end if
        call look_at_file(run, result, warnings)
        call look_at_opening(run, result, warnings)
    end subroutine find_warnings

    !> What comes in must be somewhere: the rest is the error of the integration in time.
    subroutine look_at_energy(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        real(dp), parameter :: allowed = 0.02_dp   !! part of what has passed through the system
        type(law_facts) :: law
        character(len=240) :: text
        real(dp) :: passed

        associate (e => result%energy)
            passed = max(e%most_work, abs(e%at_start), e%dissipated + e%damped)
            if (abs(e%unbalanced()) <= allowed * passed) return
            write (text, '(a, f0.1, a)') 'the balance of energy is open by ', &
                100.0_dp * abs(e%unbalanced()) / passed, ' %: take '
        end associate
        law = friction_facts(run%props)
        if (run%adaptive .and. run%across%free() .and. run%newmark .and. law%traits%onset &
            == onset_drops) then
            ! those come to ones in which the contact sticks and slips many times
            text = trim(text) // ' adaptive steps (rtol) without beta, gamma and rho_infinity, for &
                &friction that drops at once'
        else if (run%adaptive) then
            text = trim(text) // ' a smaller rtol'
        else
            text = trim(text) // ' shorter steps (dt), or steps by their error (rtol)'
        end if
        if (damps_steps(run)) text = trim(text) // '; what rho_infinity or gamma damps counts as &
            &open'
        warnings = [warnings, run_warning('energy_balance', text)]
    end subroutine look_at_energy

    !> Does the method of the steps damp oscillations?
    pure function damps_steps(run) result(damps)
        type(settings), intent(in) :: run
        logical :: damps

        damps = run%rho_infinity >= 0.0_dp .and. run%rho_infinity < 1.0_dp .or. run%mass > 0.0_dp &
            .and. run%gamma > 0.5_dp .and. .not. run%adaptive
    end function damps_steps

    !> A slip event lasts about pi sqrt(M/K).
    subroutine look_at_step(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        real(dp), parameter :: pi = acos(-1.0_dp)
        real(dp), parameter :: longest = 0.2_dp   !! step, part of a slip event
        character(len=240) :: text
        real(dp) :: lasts

        if (sum(result%pieces%events) + result%chain_events + result%unresolved == 0) return
        if (result%unresolved > 0) then
            write (text, '(a, es9.2, a, i0, a)') 'the step dt =', run%dt, ' is too long for ', &
                result%unresolved, ' slips of blocks, which begin and end within it: they are not &
                &listed as events'
            warnings = [warnings, run_warning('long_step', text)]
            return
        end if
        lasts = pi * sqrt(run%mass / run%stiffness)
        if (run%dt <= longest * lasts) return
        write (text, '(a, es9.2, a, es9.2, a)') 'the step dt =', run%dt, ' is long for slip &
            &events, which last about pi sqrt(mass/stiffness) =', lasts, ': take thirty steps &
            &or more to an event'
        warnings = [warnings, run_warning('long_step', text)]
    end subroutine look_at_step

    !> Where friction falls faster with the slip rate than the contact spring unloads in a step, it
    !> drops at once as slip begins, and the contact spring starts to ring. If nothing damps that,
    !> it decides when the block sticks again.
    subroutine look_at_contact(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        real(dp), parameter :: least = 0.05_dp   !! damping ratio of the ringing that is enough
        type(law_facts) :: law
        real(dp) :: critical   ! damping [F T/L]
        character(len=240) :: text

        if (result%energy%dissipated <= 0.0_dp .or. run%rigid_contact) return
        law = friction_facts(run%props)
        if (run%drive%largest_normal() * law%rate_weakening &
            <= run%dt * run%props(prop_alpha_t)) return
        if (damps_steps(run)) return
        critical = 2.0_dp * sqrt(run%mass * (run%stiffness + run%area * run%props(prop_alpha_t)))
        if (run%damping + run%area * law%damping >= least * critical) return
        text = 'friction drops at once when slip begins, and the contact spring (alpha_t) rings &
            &undamped: periods and stress drops depend on it. Take rho_infinity = 0 in &time'
        if (run%chain%n_blocks == 1) then
            text = trim(text) // ', a damping, eta_t, or contact = ''rigid'' in &friction with &
                &adaptive steps'
        else
            text = trim(text) // ', a damping or eta_t'
        end if
        warnings = [warnings, run_warning('undamped_contact', text)]
    end subroutine look_at_contact

    subroutine look_at_file(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        real(dp), parameter :: round_off = 1.0e-9_dp
        character(len=240) :: text

        if (result%time * (1.0_dp - round_off) <= run%drive%measured_until) return
        write (text, '(a, es12.5, a, es12.5, a)') 'the file of the drive ends at time ', &
            run%drive%measured_until, ', before t_end = ', run%t_end, ': its last velocity and &
            &normal traction went on'
        warnings = [warnings, run_warning('short_file', text)]
    end subroutine look_at_file

    !> A state that grows as the normal traction vanishes would leave the range of numbers: the
    !> contact opens before (`within_range`). Continuous time has another state.
    subroutine look_at_opening(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        real(dp), parameter :: most = 17.0_dp   !! open below 8e-6 of the largest normal traction
        character(len=240) :: text
        real(dp) :: effect

        if (result%in_rates .or. .not. run%load_vanishes()) return
        effect = pressure_effect(run%props, run%chain%constants)
        if (effect <= most) return
        write (text, '(a, f0.1, a)') 'the state grows so fast as the normal traction vanishes &
            &(alpha is ', effect, ' times b) that the contact counts as open before: what would &
            &slip there is missing. One block with adaptive steps has none of that'
        warnings = [warnings, run_warning('early_opening', text)]
    end subroutine look_at_opening

end module run_warnings
