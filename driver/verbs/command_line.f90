!> The command line: what the user asks for.
module command_line
    use, intrinsic :: iso_fortran_env, only : error_unit
    use friction_mod, only : friction_version
    use platform, only : report
    implicit none
    private

    public :: command, print_help, print_version, read_command_line

    type :: command
        character(len=:), allocatable :: verb      !! run, point, sweep, stability, fault, check,
                                                   !! --help, or --version
        character(len=:), allocatable :: input     !! namelist file
        character(len=:), allocatable :: output    !! directory
        character(len=:), allocatable :: stem      !! of the names of the files that a run writes
        logical :: plot = .true.
        logical :: quiet = .false.
        integer :: jobs = 0                        !! runs of a sweep at a time; 0: one a core
        logical :: resume = .false.
        logical :: verify = .false.
        character(len=:), allocatable :: problem   !! what is wrong with the command line; or empty
    end type command

contains

    subroutine read_command_line(wanted)
        type(command), intent(out) :: wanted

        wanted%problem = ''
        wanted%input = ''
        wanted%output = ''
        wanted%verb = argument(1)
        select case (wanted%verb)
        case ('run', 'point', 'sweep', 'stability', 'fault', 'check')
            continue
        case ('--help', '-h', 'help')
            wanted%verb = '--help'
            return
        case ('--version')
            return
        case ('')
            wanted%problem = 'no command given'
            return
        case default
            wanted%problem = "unknown command '" // wanted%verb // "'"
            return
        end select

        call read_options(wanted)
        if (wanted%verb == '--help') return
        if (len(wanted%problem) > 0) return
        if (len(wanted%input) == 0) wanted%problem = wanted%verb // ' needs an input file'
        if (wanted%verb /= 'run' .and. wanted%verify) wanted%problem = '--verify is for run'
        if (wanted%resume .and. wanted%verb /= 'run' .and. wanted%verb /= 'fault') then
            wanted%problem = '--resume is for run and fault'
        end if
        if (wanted%verb == 'check' .and. (len(wanted%output) > 0 .or. wanted%quiet &
            .or. .not. wanted%plot .or. wanted%resume &
            .or. wanted%verify)) wanted%problem = 'check takes an input file and nothing else'
        wanted%stem = stem_of(wanted%input)
        if (len(wanted%output) == 0) wanted%output = wanted%stem // '_out'
    end subroutine read_command_line

    !> What follows the verb.
    subroutine read_options(wanted)
        type(command), intent(inout) :: wanted
        character(len=:), allocatable :: word
        integer :: i

        i = 2
        do while (i <= command_argument_count())
            word = argument(i)
            i = i + 1
            select case (word)
            case ('--help', '-h')
                wanted%verb = '--help'
                return
            case ('--no-plot')
                wanted%plot = .false.
            case ('--quiet')
                wanted%quiet = .true.
            case ('--resume')
                wanted%resume = .true.
            case ('--verify')
                wanted%verify = .true.
            case ('--output')
                wanted%output = argument(i)
                i = i + 1
                if (len(wanted%output) == 0) wanted%problem = '--output needs a directory'
            case ('--jobs')
                call take_jobs(wanted, argument(i))
                i = i + 1
            case default
                call take_input(wanted, word)
            end select
        end do
    end subroutine read_options

    subroutine take_input(wanted, word)
        type(command), intent(inout) :: wanted
        character(len=*), intent(in) :: word

        if (len(wanted%problem) > 0) return   ! the first mistake is the one to tell
        if (index(word, '-') == 1) then
            wanted%problem = "unknown option '" // word // "'"
        else if (len(wanted%input) > 0) then
            wanted%problem = "one input file at a time: '" // wanted%input // "' and '" // word &
                // "'"
        else
            wanted%input = word
        end if
    end subroutine take_input

    subroutine take_jobs(wanted, word)
        type(command), intent(inout) :: wanted
        character(len=*), intent(in) :: word

        if (wanted%verb /= 'sweep') then
            wanted%problem = '--jobs is for sweep'
        else if (len(word) == 0 .or. len(word) > 4 .or. verify(word, '0123456789') > 0) then
            wanted%problem = '--jobs needs a whole number from 1 to 9999'
        else
            read (word, '(i4)') wanted%jobs
            if (wanted%jobs == 0) wanted%problem = '--jobs needs a whole number from 1 to 9999'
        end if
    end subroutine take_jobs

    function argument(i) result(word)
        integer, intent(in) :: i
        character(len=:), allocatable :: word
        integer :: length

        call get_command_argument(i, length=length)
        allocate (character(len=length) :: word)
        if (length > 0) call get_command_argument(i, word)
    end function argument

    !> A file's name without its directories and its last extension.
    pure function stem_of(path) result(stem)
        character(len=*), intent(in) :: path
        character(len=:), allocatable :: stem
        integer :: dot

        stem = path(index(path, '/', back=.true.) + 1:)
        dot = index(stem, '.', back=.true.)
        if (dot > 1) stem = stem(:dot - 1)
    end function stem_of

    subroutine print_version()
        write (report, '(2a)') 'stickslip ', friction_version
    end subroutine print_version

    !> To standard output on request, to standard error after a mistake.
    subroutine print_help(to_error)
        logical, intent(in) :: to_error
        integer :: unit

        unit = merge(error_unit, report, to_error)
        write (unit, '(a)') &
            'usage: stickslip run INPUT.nml [--output DIR] [--no-plot] [--quiet]', &
            '                     [--resume] [--verify]', &
            '       stickslip point INPUT.nml [--output DIR] [--no-plot] [--quiet]', &
            '       stickslip sweep INPUT.nml [--output DIR] [--no-plot] [--quiet] [--jobs N]', &
            '       stickslip stability INPUT.nml [--output DIR] [--no-plot] [--quiet]', &
            '       stickslip fault INPUT.nml [--output DIR] [--no-plot] [--quiet] [--resume]', &
            '       stickslip check INPUT.nml', &
            '       stickslip --help | --version', &
            '', &
            'run    integrates the slider of INPUT.nml; writes STEM.csv, STEM_events.csv and', &
            '       STEM.png (and .svg) with its script STEM.gp to STEM_out, and a summary', &
            'point  takes one contact point along a path of prescribed displacements or', &
            '       tractions; writes STEM.csv and STEM.png with its script STEM.gp', &
            'sweep  runs INPUT.nml with every combination of the values in its group &sweep;', &
            '       writes STEM_sweep.csv, one row a combination, and STEM_sweep.png with its', &
            '       script; what was interrupted continues where it stopped', &
            'stability  tells whether steady sliding of the slider is stable, and at which', &
            '       stiffness, velocity, damping and mass that changes; input of run or sweep', &
            'fault  integrates a plane in an elastic medium that slips by itself; under mpirun', &
            '       on any number of processes; writes STEM_events.csv, _global.csv, stations', &
            'check  reads and validates INPUT.nml, and runs nothing', &
            '', &
            '--output DIR  where to write', &
            '--no-plot     draw no picture', &
            '--quiet       no summary and no progress bar', &
            '--jobs N      runs of a sweep at a time (as many as there are cores)', &
            '--resume      goes on from STEM.checkpoint, which an interrupted run left', &
            '--verify      a second run at a tighter tolerance tells the error of event times', &
            ''
        call print_keys(unit)
        write (unit, '(a)') &
            'exit status: 0 done; 1 the run failed, what it wrote stays; 2 bad usage or input'
    end subroutine print_help

    subroutine print_keys(unit)
        integer, intent(in) :: unit

        write (unit, '(a)') &
            'Groups and keys of INPUT.nml, (default), [unit] of force F, length L, time T:', &
            '  &friction  law (''subloading''), alpha_n, alpha_t [F/L^3], mu_s, mu_k [-],', &
            '             kappa [1/L], xi [1/T], m [1/L], mu_0 (mu_s) [-];', &
            '             scheme, u_of_r, tau_max [F/L^2], mu_ratio, direction;', &
            '             laws coulomb, static_kinetic, rate_and_state, slip_weakening,', &
            '             slip_weakening_healing have keys of their own', &
            '  &slider    mass [F T^2/L], stiffness [F/L], damping (0) [F T/L], area (1) [L^2],', &
            '             normal_traction [F/L^2]', &
            '  &drive     velocity [L/T], duration [T], normal (normal_traction) [F/L^2]:', &
            '             lists, the i-th values hold for duration(i);', &
            '             or file; normal_change, normal_amplitude, _frequency, _phase', &
            '  &time      t_end, dt [T], beta (0.25), gamma (0.5), tolerance (1e-10),', &
            '             max_iterations (25); adaptive with rtol, dt_min, dt_max; rho_infinity', &
            '  &events    drop (1e-3), part of the static friction force; slip_rate [L/T]', &
            '  &output    interval (1): steps between two rows, or every: time between them [T];', &
            '             fields (0): of a chain; checkpoint (60) [s]; table_limit (10) [GB];', &
            '             length_unit, force_unit, time_unit: names for pictures', &
            '  &initial   mu (mu_0), r (0), displacement (0), velocity (0), spring_force', &
            '  &chain     n_blocks, coupling [F/L], ends (''free''), scatter (0), seed (1),', &
            '             displacement_scatter (0) [L], slip_rate [L/T]', &
            '  all of them: docs/driver.md', &
            'and of point, beside &friction (docs/point_mode.md):', &
            '  &point     ndir (3), cycles (1), tangent (.false.), and a path, either', &
            '             duration [T], steps, control_n, control_t1, control_t2', &
            '             (''displacement'' or ''traction''), target_n, target_t1, target_t2', &
            '             [L] or [F/L^2]: lists, the i-th values belong to segment i;', &
            '             or file = CSV with time and u_ or t_ columns, substeps (1)', &
            'and of sweep, beside the groups of a run (docs/sweeps.md):', &
            '  &sweep     key (''group%key''), values: list; key2, values2: a second key', &
            'and of fault, beside &friction and &time t_end, rtol, scheme (docs/fault.md):', &
            '  &fault     geometry (''antiplane_half''; ''whole'': with length, nx, poisson),', &
            '             width [L], nz, shear_modulus, wave_speed, plate_rate [L/T],', &
            '             normal_traction, initial (''steady''; ''file'': initial_file)', &
            '  &output    stations [L], seismic_rate (1e-3) [L/T], slip_contours, interval (1),', &
            '             fields (0), checkpoint (60) [s]', &
            ''
    end subroutine print_keys

end module command_line
