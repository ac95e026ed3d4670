!> What a user should know about a run that came to its end: where its results may not be what the
!> model means (docs/driver.md, warnings).
module run_warnings
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_facts, law_facts, onset_drops
    use law_facts, only : pressure_effect
    use number_text, only : rounded_text
    use run_outcome, only : outcome
    use run_settings, only : settings
    implicit none
    private

    public :: find_warnings, run_warning

    type :: run_warning
        character(len=16) :: code = ''     !! one word, for tables
        character(len=400) :: text = ''    !! one line
    end type run_warning

    !> What friction does when slip begins.
    type :: drop_of_friction
        real(dp) :: slope = 0.0_dp      !! at which it falls with the slip rate [F T/L]
        real(dp) :: force = 0.0_dp      !! by which it does [F]
        real(dp) :: swing = 0.0_dp      !! of the block on both springs [rad/T]
        real(dp) :: time = 0.0_dp       !! in which the drive makes up for it [T]
        real(dp) :: velocity = 0.0_dp   !! of a block that slides [L/T]
    end type drop_of_friction

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
            write (text, '(a, f0.1, a)') 'the energy balance has an error of ', &
                100.0_dp * abs(e%unbalanced()) / passed, ' %: use '
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
            text = trim(text) // ' shorter steps (dt), or adaptive steps (rtol)'
        end if
        if (damps_steps(run)) text = trim(text) // '; energy that rho_infinity or gamma &
            &damps is part of this error'
        warnings = [warnings, run_warning('energy_balance', text)]
    end subroutine look_at_energy

    !> Does the method of the steps damp oscillations?
    pure logical function damps_steps(run) result(damps)
        type(settings), intent(in) :: run

        damps = run%rho_infinity >= 0.0_dp .and. run%rho_infinity < 1.0_dp .or. run%mass > 0.0_dp &
            .and. run%gamma > 0.5_dp .and. .not. run%adaptive
    end function damps_steps

    !> How long a slip event lasts, about [T].
    pure real(dp) function event_duration(run) result(lasts)
        type(settings), intent(in) :: run
        real(dp), parameter :: pi = acos(-1.0_dp)

        lasts = pi * sqrt(run%mass / run%stiffness)
    end function event_duration

    !> The longest fixed step that follows an event [T]. Where friction drops at once, the moments
    !> count at which it does and the block stops.
    pure real(dp) function longest_step(run, law) result(dt)
        type(settings), intent(in) :: run
        type(law_facts), intent(in) :: law

        dt = merge(0.05_dp, 0.2_dp, law%rate_weakening > 0.0_dp) * event_duration(run)
    end function longest_step

    subroutine look_at_step(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        character(len=240) :: text

        if (sum(result%pieces%events) + result%chain_events + result%unresolved == 0) return
        if (result%unresolved > 0) then
            write (text, '(3a, i0, a)') 'the step dt =', rounded_text(run%dt, 9, 2), &
                ' is too long for ', result%unresolved, &
                ' slips of blocks, which begin and end within it: they are not listed as events'
            warnings = [warnings, run_warning('long_step', text)]
            return
        end if
        if (run%dt <= longest_step(run, friction_facts(run%props))) return
        text = 'the step dt =' // rounded_text(run%dt, 9, 2) // ' is long for slip events, which ' &
            // 'last about pi sqrt(mass/stiffness) =' // rounded_text(event_duration(run), 9, 2) &
            // ': use thirty steps or more per event'
        warnings = [warnings, run_warning('long_step', text)]
    end subroutine look_at_step

    !> Where friction falls with the slip rate in less time than the contact spring takes to swing,
    !> or in less than a step unloads it, it drops at once as slip begins. What follows depends on
    !> the contact spring, unless its ringing has died away by the time in which the drive makes up
    !> for the drop. Fixed steps in which a block that slides moves less than the drop takes of the
    !> contact spring stick in between: friction is then on the way from `mu_k` to `mu_s` again and
    !> again, however much is damped. Newmark's adaptive steps become as short as that.
    subroutine look_at_contact(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        real(dp), parameter :: slow = 20.0_dp, slower = 50.0_dp   !! falls, of a swing [rad]
        real(dp), parameter :: even = 0.5_dp   !! fall in a step that is still one without a jump
        real(dp), parameter :: far = 4.0_dp
        type(law_facts) :: law
        type(drop_of_friction) :: drop
        real(dp) :: by_step   ! how much the contact spring loads at a unit of velocity [F T/L]
        logical :: slides_on, jumps

        law = friction_facts(run%props)
        drop = find_drop(run, law)
        if (drop%slope <= run%area * law%damping .or. result%energy%dissipated <= 0.0_dp &
            .or. run%rigid_contact) return
        by_step = run%area * law%alpha_t * run%dt
        if (run%adaptive) then
            if (run%mass * drop%swing >= merge(slow, slower, result%in_rates) * drop%slope) return
            if (dies_away(run, law, drop) .and. result%in_rates) return
        else
            jumps = drop%slope > even * by_step
            if (run%mass * drop%swing >= slow * drop%slope .and. .not. jumps) return
            slides_on = by_step * drop%velocity >= far * drop%force .or. .not. jumps
            if (slides_on .and. dies_away(run, law, drop)) return
        end if
        warnings = [warnings, run_warning('undamped_contact', 'friction drops at once when slip &
            &begins, and the contact spring (alpha_t) rings undamped or sticks in between: &
            &periods, stress drops and friction depend on it. Use ' // remedies(run, law, drop))]
    end subroutine look_at_contact

    type(drop_of_friction) function find_drop(run, law) result(drop)
        type(settings), intent(in) :: run
        type(law_facts), intent(in) :: law
        real(dp) :: normal, fastest   ! [F], [L/T]

        normal = run%area * run%drive%largest_normal()
        fastest = maxval(abs(run%drive%velocity))
        drop%slope = normal * law%rate_weakening
        drop%force = normal * (law%typical_coefficient - law%kinetic_coefficient)
        drop%swing = sqrt((run%stiffness + run%area * law%alpha_t) / run%mass)
        drop%time = drop%force / max(run%stiffness * fastest, tiny(1.0_dp))
        drop%velocity = max(fastest, drop%force / (sqrt(run%stiffness * run%mass) + run%damping))
    end function find_drop

    !> Has the ringing died away before the drive has made up for the drop? And does the contact,
    !> which swings about the spring's force when the block stops, hold in the other sense?
    pure logical function dies_away(run, law, drop)
        type(settings), intent(in) :: run
        type(law_facts), intent(in) :: law
        type(drop_of_friction), intent(in) :: drop
        real(dp), parameter :: pi = acos(-1.0_dp), enough = 4.0_dp, safe = 0.8_dp
        real(dp) :: rate, turn   ! [1/T], [-]

        rate = ringing_decay(run, drop%swing)
        associate (static => law%typical_coefficient, kinetic => law%kinetic_coefficient)
            turn = kinetic - (1.0_dp + exp(-rate * pi / drop%swing)) * (static - kinetic)
            dies_away = rate * drop%time >= enough .and. turn >= -safe * static
        end associate
    end function dies_away

    !> At which rate the contact's ringing dies away, by the damper and by fixed steps [1/T].
    pure real(dp) function ringing_decay(run, swing) result(rate)
        type(settings), intent(in) :: run
        real(dp), intent(in) :: swing   !! [1/T]
        real(dp) :: x, step_part

        rate = 0.5_dp * run%damping / run%mass
        if (run%adaptive) return
        x = (swing * run%dt)**2
        step_part = 0.5_dp * (run%gamma - 0.5_dp) * x / (1.0_dp + 0.25_dp * x)
        if (run%rho_infinity >= 0.0_dp) step_part = 0.5_dp * ((1.0_dp - run%rho_infinity) &
            / (1.0_dp + run%rho_infinity))**3 * (x / (1.0_dp + x))**2
        rate = rate / (1.0_dp + 0.25_dp * x) + step_part / run%dt
    end function ringing_decay

    !> What makes the contact that of textbooks, and in which steps it does.
    function remedies(run, law, drop) result(text)
        type(settings), intent(in) :: run
        type(law_facts), intent(in) :: law
        type(drop_of_friction), intent(in) :: drop
        character(len=:), allocatable :: text
        type(settings) :: other

        text = ''
        if (run%chain%n_blocks == 1) text = 'contact = ''rigid'' in &friction and rtol in &time &
            &without beta, gamma and rho_infinity; '
        other = run
        other%adaptive = .false.
        other%rho_infinity = 0.0_dp
        other%dt = min(1.0_dp / drop%swing, run%t_end)
        if (dies_away(other, law, drop) .and. other%dt <= longest_step(run, law)) text = text &
            // 'rho_infinity = 0 with dt = ' // trim(adjustl(rounded_text(other%dt, 9, 2))) // '; '
        if (len(text) > 0) text = text // 'or '
        text = text // 'eta_t above ' // trim(adjustl(rounded_text(drop%slope / run%area, 9, 2)))
        if (run%chain%n_blocks > 1 .and. run%adaptive) text = text // ' in fixed steps'
    end function remedies

    subroutine look_at_file(run, result, warnings)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable, intent(inout) :: warnings(:)
        real(dp), parameter :: round_off = 1.0e-9_dp
        character(len=240) :: text

        if (result%time * (1.0_dp - round_off) <= run%drive%measured_until) return
        text = 'the file of the drive ends at time ' &
            // rounded_text(run%drive%measured_until, 12, 5) // ', before t_end = ' &
            // rounded_text(run%t_end, 12, 5) // ': its last velocity and normal traction were kept'
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
        write (text, '(a, f0.1, a)') 'as the normal traction vanishes the state grows so fast &
            &(alpha is ', effect, ' times b) that the contact counts as open too early: its last &
            &slip is missing. Adaptive steps of one block have no such limit'
        warnings = [warnings, run_warning('early_opening', text)]
    end subroutine look_at_opening

end module run_warnings
