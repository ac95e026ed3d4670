!> Fields of a chain over time: slip rate, slip and friction coefficient of each block, in the files
!> of field_file, described to ParaView as a map over blocks and time.
module chain_fields
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use field_file, only : field_parts, field_record_bytes, whole_words
    use friction_mod, only : statev_mu, statev_slip
    use number_text, only : full_row
    use platform, only : rename_file
    use slider_system, only : slider_state
    use text_file, only : output_file
    implicit none
    private

    public :: chain_field_file, chain_record_bytes, sample_fields

    integer, parameter :: slip_rate = 1, slip = 2, coefficient = 3
    character(len=9), parameter :: names(3) = ['slip_rate', 'slip     ', 'mu       ']

    type :: chain_field_file
        type(field_parts) :: parts
        integer :: n_blocks = 0   !! 0: no fields are wanted
    contains
        procedure :: prepare, go_on, write_record, save, bytes
        procedure, private :: describe
    end type chain_field_file

contains

    pure integer(int64) function chain_record_bytes(n_blocks) result(bytes)
        integer, intent(in) :: n_blocks

        bytes = field_record_bytes(int(n_blocks, int64), size(names))
    end function chain_record_bytes

    !> For the records of a new run.
    subroutine prepare(self, base, n_blocks)
        class(chain_field_file), intent(inout) :: self
        character(len=*), intent(in) :: base
        integer, intent(in) :: n_blocks
        integer :: i

        self%n_blocks = n_blocks
        call self%parts%prepare(base, names, [character(len=5) :: 'block', ''], &
            [(real(i, dp), i = 1, n_blocks)], [1.0_dp])
    end subroutine prepare

    !> Goes on in the files of an interrupted run, behind its first records.
    subroutine go_on(self, base, n_blocks, records)
        class(chain_field_file), intent(inout) :: self
        character(len=*), intent(in) :: base
        integer, intent(in) :: n_blocks
        integer(int64), intent(in) :: records

        call self%prepare(base, n_blocks)
        call self%parts%find(records)
        if (.not. self%parts%failed) call self%parts%read_own(records)
    end subroutine go_on

    !> The blocks after the step from `old` to `new`; slip rates are those of the step.
    subroutine write_record(self, old, new)
        class(chain_field_file), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        real(dp) :: dt

        dt = max(new%time - old%time, tiny(dt))
        call self%parts%next(new%time)
        call self%parts%put(slip_rate, (new%statev(:, statev_slip) - old%statev(:, statev_slip)) &
            / dt)
        call self%parts%put(slip, new%statev(:, statev_slip))
        call self%parts%put(coefficient, new%statev(:, statev_mu))
        if (self%parts%is_full()) call self%save()
    end subroutine write_record

    !> Brings all records into the files, and describes them.
    subroutine save(self)
        class(chain_field_file), intent(inout) :: self

        if (self%n_blocks == 0) return
        if (self%parts%is_saved() .or. self%parts%failed) return
        call self%parts%lay_out()
        if (.not. self%parts%failed) call self%parts%write_own()
        if (self%parts%failed) then
            call self%parts%withdraw()
            return
        end if
        call self%parts%publish()
        if (self%parts%failed) return
        self%parts%saved = self%parts%records
        call self%describe()
    end subroutine save

    !> Of all records, without what describes them.
    pure integer(int64) function bytes(self)
        class(chain_field_file), intent(in) :: self

        bytes = 0
        if (self%n_blocks > 0) bytes = self%parts%records * chain_record_bytes(self%n_blocks)
    end function bytes

    !> BASE_fields.xdmf: blocks and times are the nodes of a map, or of several where the files hold
    !> the records apart.
    subroutine describe(self)
        class(chain_field_file), intent(inout) :: self
        type(output_file) :: file
        character(len=:), allocatable :: name
        integer(int64) :: first, n
        integer :: i

        name = self%parts%base // '_fields.xdmf'
        call file%create(name // '.new')
        call file%write_line('<?xml version="1.0"?><Xdmf Version="2.0"><Domain>')
        call file%write_line('<Grid GridType="Collection" CollectionType="Spatial">')
        first = 1
        do while (first <= self%parts%saved)
            n = self%parts%last_together(first) - first + 1
            call file%write_line('<Grid><Topology TopologyType="2DRectMesh" Dimensions="' &
                // whole_words([n, int(self%n_blocks, int64)]) // '"/><Geometry ' &
                // 'GeometryType="VXVY"><DataItem Format="XML" Dimensions="' &
                // whole_words([int(self%n_blocks, int64)]) // '">')
            do i = 1, self%n_blocks
                call file%write_line(whole_words([int(i, int64)]))
            end do
            call file%write_line('</DataItem>' // self%parts%data_item(0, first, n) &
                // '</Geometry>')
            do i = 1, size(names)
                call file%write_line('<Attribute Name="' // trim(names(i)) &
                    // '" Center="Node">' // self%parts%data_item(i, first, n) // '</Attribute>')
            end do
            call file%write_line('</Grid>')
            first = first + n
        end do
        call file%write_line('</Grid></Domain></Xdmf>')
        call file%finish()
        self%parts%failed = self%parts%failed .or. file%failed
        if (.not. self%parts%failed) self%parts%failed = .not. rename_file(name // '.new', name)
    end subroutine describe

    !> BASE_fields.dat for a picture: slip rates in cells of blocks and times, in each the largest;
    !> `time block slip_rate` where a cell begins, an empty line after each time. What ends the last
    !> cells has their values, too.
    subroutine sample_fields(base, n_blocks, done)
        character(len=*), intent(in) :: base
        integer, intent(in) :: n_blocks
        logical, intent(out) :: done
        integer, parameter :: most_cells = 300   !! in either direction
        type(chain_field_file) :: fields
        type(output_file) :: sample
        real(dp) :: rate(n_blocks)
        real(dp), allocatable :: largest(:)
        real(dp) :: start
        integer(int64) :: records, i
        integer :: times, blocks, k

        call fields%prepare(base, n_blocks)
        records = fields%parts%count_saved()
        call fields%parts%find(records)
        times = int((records - 1) / most_cells) + 1
        blocks = (n_blocks - 1) / most_cells + 1
        largest = spread(0.0_dp, 1, (n_blocks - 1) / blocks + 1)
        call sample%create(base // '_fields.dat')
        start = 0.0_dp
        do i = 1, records
            call fields%parts%read_record(i, slip_rate, rate)
            if (fields%parts%failed) exit
            do k = 1, size(largest)
                largest(k) = max(largest(k), maxval(rate(1 + (k - 1) * blocks:min(n_blocks, &
                    k * blocks))))
            end do
            if (mod(i, int(times, int64)) > 0 .and. i < records) cycle
            call write_cells()
            start = fields%parts%times(i)
            if (i == records) call write_cells()
            largest = 0.0_dp
        end do
        call sample%finish()
        done = records > 0 .and. .not. (fields%parts%failed .or. sample%failed)

    contains

        subroutine write_cells()
            integer :: k

            do k = 1, size(largest)
                call sample%write_line(full_row([start, 0.5_dp + (k - 1) * blocks, largest(k)], &
                    ' '))
            end do
            call sample%write_line(full_row([start, 0.5_dp + n_blocks, largest(size(largest))], &
                ' '))
            call sample%write_line('')
        end subroutine write_cells

    end subroutine sample_fields

end module chain_fields
