!> Checkpoints: all that a run needs to go on as if it had never stopped, in one file that is
!> written whole and then takes the place of the one before.
module checkpoint
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use chain_events, only : chain_finder
    use platform, only : rename_file
    use recorder, only : csv_recorder
    use run_outcome, only : outcome
    use run_settings, only : settings
    use slider_system, only : slider_state
    use slip_events, only : event_finder
    use step_control, only : stepper
    implicit none
    private

    public :: read_checkpoint, snapshot, write_checkpoint

    !> A run between two steps.
    type :: snapshot
        type(slider_state) :: state
        type(stepper) :: steps
        type(event_finder) :: finder
        type(chain_finder) :: chain
        type(outcome) :: result
        integer :: rows_due = 0   !! steps since the last row
        integer :: fields_due = 0   !! steps since the last fields
    end type snapshot

    character(len=*), parameter :: first_words = 'stickslip checkpoint 3', last_words = 'end'

contains

    !> Leaves the checkpoint before in place if this one cannot be written.
    subroutine write_checkpoint(name, run, now, records)
        character(len=*), intent(in) :: name
        type(settings), intent(in) :: run
        type(snapshot), intent(in) :: now
        type(csv_recorder), intent(inout) :: records
        integer :: unit, status
        integer(int64) :: expected, written
        logical :: renamed

        call records%flush_all()
        if (records%failed()) return
        open (newunit=unit, file=name // '.new', access='stream', form='unformatted', &
            status='replace', action='write', iostat=status)
        if (status /= 0) return
        associate (x => now%state, s => now%steps, r => now%result)
            write (unit, iostat=status) first_words, digest(run), size(x%x), size(r%pieces), &
                size(r%onsets), now%chain%count, x%time, x%drive, x%normal, x%drive_work, &
                x%damped, x%x, x%v, x%a, x%spring, x%friction, x%statev, s%origin, s%dt, &
                s%passed, s%parts, s%rejected, s%iterations, s%most_iterations, s%last_error, &
                s%rule%contact, now%finder, r%steps, r%snap_backs, r%peak_velocity, r%energy, &
                r%pieces, r%onsets, r%chain_events, r%largest_moment, now%rows_due, &
                now%fields_due, records%rows, records%series%bytes, records%events%bytes, &
                records%fields_place()
            ! by itself: flang 22 ends a statement at an array of no elements of a derived type
            if (now%chain%count > 0 .and. status == 0) then
                write (unit, iostat=status) now%chain%events(:now%chain%count)
            end if
            if (status == 0) write (unit, iostat=status) last_words
        end associate
        inquire (unit=unit, pos=expected)
        close (unit)
        inquire (file=name // '.new', size=written)
        if (status == 0 .and. written == expected - 1) then
            renamed = rename_file(name // '.new', name)
        end if
    end subroutine write_checkpoint

    !> Fills a snapshot, allocated as at the start of the run, and the place of the files' ends.
    !> `problem` says why the run cannot go on from there.
    subroutine read_checkpoint(name, run, now, rows, bytes, problem)
        character(len=*), intent(in) :: name
        type(settings), intent(in) :: run
        type(snapshot), intent(inout) :: now
        integer, intent(out) :: rows             !! of the time series
        integer(int64), intent(out) :: bytes(3)  !! of the time series, events, fields
        character(len=:), allocatable, intent(out) :: problem
        character(len=len(first_words)) :: first
        character(len=len(last_words)) :: last
        integer(int64) :: seen
        integer :: unit, status, blocks, pieces, events, under_way

        rows = 0
        bytes = 0
        problem = ''
        open (newunit=unit, file=name, access='stream', form='unformatted', status='old', &
            action='read', iostat=status)
        if (status /= 0) then
            problem = 'there is no checkpoint ' // name
            return
        end if
        read (unit, iostat=status) first, seen, blocks, pieces, events, under_way
        if (status /= 0 .or. first /= first_words) then
            problem = name // ' is no checkpoint of this version'
        else if (seen /= digest(run) .or. blocks /= size(now%state%x) &
            .or. pieces /= size(now%result%pieces)) then
            problem = 'the input is not the one that wrote the checkpoint ' // name
        else
            deallocate (now%result%onsets, now%chain%events)
            allocate (now%result%onsets(events), now%chain%events(max(1, under_way)))
            now%chain%count = under_way
            associate (x => now%state, s => now%steps, r => now%result)
                read (unit, iostat=status) x%time, x%drive, x%normal, x%drive_work, x%damped, &
                    x%x, x%v, x%a, x%spring, x%friction, x%statev, s%origin, s%dt, s%passed, &
                    s%parts, s%rejected, s%iterations, s%most_iterations, s%last_error, &
                    s%rule%contact, now%finder, r%steps, r%snap_backs, r%peak_velocity, &
                    r%energy, r%pieces, r%onsets, r%chain_events, r%largest_moment, &
                    now%rows_due, now%fields_due, rows, bytes
                if (under_way > 0 .and. status == 0) then
                    read (unit, iostat=status) now%chain%events(:under_way)
                end if
                if (status == 0) read (unit, iostat=status) last
            end associate
            if (status /= 0 .or. last /= last_words) problem = name // ' is damaged'
        end if
        close (unit)
    end subroutine read_checkpoint

    !> A number that is another for other settings, as far as they change the results.
    pure function digest(run) result(mixed)
        type(settings), intent(in) :: run
        integer(int64) :: mixed

        mixed = 0
        associate (d => run%drive, start => run%initial, c => run%chain)
            call mix([run%props, run%mass, run%stiffness, run%damping, run%area, run%t_end, &
                run%dt, run%rtol, run%dt_min, run%dt_max, run%beta, run%gamma, run%rho_infinity, &
                run%tolerance, real(run%max_iterations, dp), real(run%interval, dp), run%every, &
                start%mu, &
                start%r, start%displacement, start%velocity, start%spring_force], mixed)
            call mix([real(c%n_blocks, dp), c%coupling, real(c%ends, dp), c%scatter, &
                real(c%seed, dp), c%slip_rate, real(run%fields, dp)], mixed)
            call mix([d%start, d%travel, d%velocity, d%acceleration, d%normal, d%normal_rate, &
                d%amplitude, d%frequency, d%phase], mixed)
        end associate
    end function digest

    pure subroutine mix(numbers, mixed)
        real(dp), intent(in) :: numbers(:)
        integer(int64), intent(inout) :: mixed
        integer :: i

        do i = 1, size(numbers)
            mixed = ieor(ishftc(mixed, 23), transfer(numbers(i), mixed))
            mixed = ieor(mixed, shiftl(mixed, 13))
            mixed = ieor(mixed, shiftr(mixed, 7))
        end do
    end subroutine mix

end module checkpoint
